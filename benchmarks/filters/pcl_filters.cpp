// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pcl_filters.hpp"

#include <cmath>
#include <numeric>

#include <pcl/features/integral_image_normal.h>
#include <pcl/filters/fast_bilateral.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/shadowpoints.h>
#include <pcl/filters/statistical_outlier_removal.h>

namespace tofmap::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

Cloud::Ptr cloud_of(const RangeImage& image, const PixelRays& rays) {
  Cloud::Ptr cloud(new Cloud(static_cast<std::uint32_t>(image.cols()),
                             static_cast<std::uint32_t>(image.rows())));
  for (Eigen::Index i = 0; i < image.range_m.size(); ++i) {
    const float range_m = image.range_m.data()[i];  // NaN where invalid
    (*cloud)[static_cast<std::size_t>(i)] = {range_m * rays.x.data()[i], range_m * rays.y.data()[i],
                                             range_m * rays.z.data()[i]};
  }
  cloud->is_dense = false;
  return cloud;
}

/// The indices of the valid pixels. PCL's searches abort the program if a point is NaN.
pcl::IndicesPtr valid_pixels(const RangeImage& image) {
  pcl::IndicesPtr indices(new pcl::Indices);
  for (Eigen::Index i = 0; i < image.reason.size(); ++i) {
    if (image.reason.data()[i] == 0) indices->push_back(static_cast<pcl::index_t>(i));
  }
  return indices;
}

/// The image with the pixels invalidated that a PCL filter removes. `given` are the indices of the
/// pixels in the filter's input cloud.
template <class PclFilter>
RangeImage without_removed(PclFilter& filter, const pcl::Indices& given, const RangeImage& image) {
  pcl::Indices kept;
  filter.filter(kept);
  Image<bool> is_kept = Image<bool>::Constant(image.rows(), image.cols(), false);
  for (const auto index : kept) is_kept.data()[given[static_cast<std::size_t>(index)]] = true;
  RangeImage out = image;
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      if (image.valid(row, col) && !is_kept(row, col)) {
        out.invalidate(row, col, InvalidReason::outlier);
      }
    }
  }
  return out;
}

/// Sets the cloud of valid points as the input of a PCL filter, and returns the image with the
/// pixels invalidated that it removes.
template <class PclFilter>
RangeImage without_removed(PclFilter& filter, const Case& example, const RangeImage& image) {
  const pcl::IndicesPtr valid = valid_pixels(image);
  filter.setInputCloud(Cloud::ConstPtr(new Cloud(*cloud_of(image, example.rays), *valid)));
  return without_removed(filter, *valid, image);
}

/// Removes points whose plane nearly contains the line of sight: those whose distance to the camera
/// along the normal is below `threshold_m`.
RangeImage without_shadows(const Case& example, const Sample& sample, float threshold_m) {
  const Cloud::Ptr cloud = cloud_of(sample.unwrapped, example.rays);
  pcl::PointCloud<pcl::Normal>::Ptr normals(new pcl::PointCloud<pcl::Normal>);
  pcl::IntegralImageNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setNormalEstimationMethod(estimation.AVERAGE_3D_GRADIENT);
  estimation.setMaxDepthChangeFactor(0.02F);
  estimation.setNormalSmoothingSize(10);
  estimation.setInputCloud(cloud);
  estimation.compute(*normals);
  pcl::ShadowPoints<pcl::PointXYZ, pcl::Normal> filter(true);
  filter.setInputCloud(cloud);
  filter.setNormals(normals);
  filter.setThreshold(threshold_m);
  pcl::Indices all(cloud->size());
  std::iota(all.begin(), all.end(), 0);
  return without_removed(filter, all, sample.unwrapped);
}

RangeImage without_outliers(const Case& example, const Sample& sample, int neighbours,
                            double deviations) {
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> filter;
  filter.setMeanK(neighbours);
  filter.setStddevMulThresh(deviations);
  return without_removed(filter, example, sample.unwrapped);
}

RangeImage without_lone_points(const Case& example, const Sample& sample, double radius_m,
                               int neighbours) {
  pcl::RadiusOutlierRemoval<pcl::PointXYZ> filter;
  filter.setRadiusSearch(radius_m);
  filter.setMinNeighborsInRadius(neighbours);
  return without_removed(filter, example, sample.unwrapped);
}

RangeImage smoothed(const Case& example, const Sample& sample, float sigma_px, float sigma_m) {
  pcl::FastBilateralFilter<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud_of(sample.unwrapped, example.rays));
  filter.setSigmaS(sigma_px);
  filter.setSigmaR(sigma_m);
  Cloud smooth;
  filter.filter(smooth);
  RangeImage out = sample.unwrapped;
  for (Eigen::Index i = 0; i < out.range_m.size(); ++i) {
    const float depth_m = smooth[static_cast<std::size_t>(i)].z;
    if (std::isfinite(out.range_m.data()[i]) && std::isfinite(depth_m)) {
      out.range_m.data()[i] = depth_m / example.rays.z.data()[i];
    }
  }
  return out;
}

}  // namespace

std::vector<MeasuredFilter> pcl_filters() {
  return {{"PCL ShadowPoints, 0.1 m",
           [](const Case& c, const Sample& s) { return without_shadows(c, s, 0.1F); }},
          {"PCL StatisticalOutlierRemoval, 50, 1",
           [](const Case& c, const Sample& s) { return without_outliers(c, s, 50, 1); }},
          {"PCL StatisticalOutlierRemoval, 8, 2",
           [](const Case& c, const Sample& s) { return without_outliers(c, s, 8, 2); }},
          {"PCL RadiusOutlierRemoval, 0.1 m, 4",
           [](const Case& c, const Sample& s) { return without_lone_points(c, s, 0.1, 4); }},
          {"PCL FastBilateralFilter, 2 px, 5 cm",
           [](const Case& c, const Sample& s) { return smoothed(c, s, 2, 0.05F); }}};
}

}  // namespace tofmap::bench
