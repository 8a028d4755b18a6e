// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pcl_points.hpp"
#include "tofmap/registration/global_alignment.hpp"

#include <algorithm>
#include <cmath>

#include <pcl/features/fpfh_omp.h>
#include <pcl/kdtree/kdtree_flann.h>

namespace tofmap {
namespace {

using Signature = pcl::FPFHSignature33;
using SignatureTree = pcl::KdTreeFLANN<Signature>;

constexpr double radius_voxels = 5;
constexpr std::size_t most_matches = 3000;

pcl::PointCloud<Signature>::Ptr signatures(const std::vector<PointFeature>& features) {
  auto cloud = std::make_shared<pcl::PointCloud<Signature>>();
  cloud->resize(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    std::ranges::copy(features[i], (*cloud)[i].histogram);
  }
  return cloud;
}

/// For each feature, the index of the most similar one of `others`.
std::vector<int> most_alike(const pcl::PointCloud<Signature>& features,
                            const pcl::PointCloud<Signature>::Ptr& others) {
  SignatureTree tree;
  tree.setInputCloud(others);
  std::vector<int> alike(features.size());
  const int count = static_cast<int>(features.size());
#pragma omp parallel for schedule(dynamic, 64)
  for (int i = 0; i < count; ++i) {
    pcl::Indices index(1);
    std::vector<float> squared_gap(1);
    tree.nearestKSearch(features[i], 1, index, squared_gap);
    alike[i] = index[0];
  }
  return alike;
}

}  // namespace

std::vector<PointFeature> point_features(const OrientedCloud& cloud) {
  auto normals = std::make_shared<pcl::PointCloud<pcl::Normal>>();
  for (const Eigen::Vector3f& normal : cloud.normals) {
    normals->push_back({normal.x(), normal.y(), normal.z()});
  }
  pcl::FPFHEstimationOMP<pcl::PointXYZ, pcl::Normal, Signature> estimation;
  estimation.setInputCloud(pcl_points(cloud.points_m));
  estimation.setInputNormals(normals);
  estimation.setRadiusSearch(radius_voxels * cloud.voxel_m);
  pcl::PointCloud<Signature> signatures;
  estimation.compute(signatures);
  std::vector<PointFeature> features(signatures.size());
  for (std::size_t i = 0; i < signatures.size(); ++i) {
    std::ranges::copy(signatures[i].histogram, features[i].begin());
    // The histogram of a point without neighbours is NaN, which a search tree cannot hold.
    for (float& value : features[i]) value = std::isfinite(value) ? value : 0;
  }
  return features;
}

std::vector<FeatureMatch> match_features(const std::vector<PointFeature>& source,
                                         const std::vector<PointFeature>& target) {
  if (source.empty() || target.empty()) return {};
  const auto source_cloud = signatures(source);
  const auto target_cloud = signatures(target);
  const std::vector<int> in_target = most_alike(*source_cloud, target_cloud);
  const std::vector<int> in_source = most_alike(*target_cloud, source_cloud);
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < static_cast<int>(in_target.size()); ++i) {
    const int other = in_target[static_cast<std::size_t>(i)];
    if (in_source[static_cast<std::size_t>(other)] == i) matches.push_back({i, other});
  }
  if (matches.size() <= most_matches) return matches;
  std::vector<FeatureMatch> drawn;
  for (std::size_t i = 0; i < most_matches; ++i) {
    drawn.push_back(matches[i * matches.size() / most_matches]);
  }
  return drawn;
}

}  // namespace tofmap
