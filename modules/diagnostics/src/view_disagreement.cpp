// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/view_disagreement.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// The plane of the surface in a patch of an image, in the frame of its camera.
struct Patch {
  Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();  ///< on the plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();    ///< unit, away from the camera
  bool is_plane = false;
};

/// The patches of an image, by row and column.
using Patches = Eigen::Array<Patch, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A frame as planes.
struct PlanarFrame {
  Patches patches;
  Pose world_from_camera;
};

int patch_size_px(const CameraModel& camera) {
  constexpr int least_px = 8;  // fewer pixels do not average enough noise
  constexpr int patches_wide = 22;
  return std::max(least_px, camera.width_px / patches_wide);
}

/// Fits a plane to a square of pixels: in inverse depth, it is linear in the tangents of the rays.
Patch fit_patch(const RangeImage& image, const PixelRays& rays, Eigen::Index row, Eigen::Index col,
                int size_px) {
  constexpr double least_share = 0.75;      // of the pixels must be valid
  constexpr double least_cosine = 0.35;     // of the angle of incidence: 70 degrees
  constexpr double least_scatter_m = 0.02;  // that of a surface with some relief
  constexpr double times_noise = 2;
  Eigen::Matrix3d normal_matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side = Eigen::Vector3d::Zero();
  double square_sum = 0;
  double variance_sum_m2 = 0;
  double depth_sum_m = 0;
  Eigen::Vector3d tangents = Eigen::Vector3d::Zero();
  int count = 0;
  for (Eigen::Index v = row; v < row + size_px; ++v) {
    for (Eigen::Index u = col; u < col + size_px; ++u) {
      if (!image.valid(v, u)) continue;
      const double z = rays.z(v, u);
      const double depth_m = image.range_m(v, u) * z;
      const Eigen::Vector3d ray(rays.x(v, u) / z, rays.y(v, u) / z, 1);
      normal_matrix += ray * ray.transpose();
      right_side += ray / depth_m;
      square_sum += 1 / (depth_m * depth_m);
      variance_sum_m2 += image.variance_m2(v, u);
      depth_sum_m += depth_m;
      tangents += ray;
      ++count;
    }
  }
  Patch patch;
  if (count < least_share * size_px * size_px) return patch;
  const Eigen::Vector3d plane = normal_matrix.ldlt().solve(right_side);  // plane · point = 1
  const Eigen::Vector3d ray = tangents / count;
  const double inverse_depth = plane.dot(ray);
  if (!(inverse_depth > 0)) return patch;
  patch.centre_m = ray / inverse_depth;
  patch.normal = plane.normalized();
  const double mean_depth_m = depth_sum_m / count;
  const double scatter_m = std::sqrt(std::max(0.0, square_sum - plane.dot(right_side)) / count) *
                           mean_depth_m * mean_depth_m;
  const double noise_m = std::sqrt(variance_sum_m2 / count);
  patch.is_plane = scatter_m < least_scatter_m + times_noise * noise_m &&
                   patch.normal.dot(patch.centre_m) > least_cosine * patch.centre_m.norm();
  return patch;
}

Patches patches_of(const RangeImage& image, const PixelRays& rays, int size_px) {
  Patches patches(image.rows() / size_px, image.cols() / size_px);
  for (Eigen::Index row = 0; row < patches.rows(); ++row) {
    for (Eigen::Index col = 0; col < patches.cols(); ++col) {
      patches(row, col) = fit_patch(image, rays, row * size_px, col * size_px, size_px);
    }
  }
  return patches;
}

/// Signed distance of the centre of each patch of one frame from the plane that the other frame has
/// there. NaN where that is no view of the same surface. The small rotations by which poses are
/// uncertain move surfaces in proportion to their range, so distances of surfaces that are far away
/// are scaled down.
ImageF distances_m(const PlanarFrame& from, const PlanarFrame& to, const CameraModel& camera,
                   int size_px) {
  constexpr double same_direction = 0.94;  // cosine of 20 degrees
  constexpr double same_surface_m = 0.3;   // what is farther away is another surface
  constexpr double far_m = 8;              // rooms are smaller
  const Pose to_from_from = to.world_from_camera.inverse() * from.world_from_camera;
  ImageF distances = ImageF::Constant(from.patches.rows(), from.patches.cols(), nan);
  for (Eigen::Index i = 0; i < distances.size(); ++i) {
    const Patch& patch = from.patches.data()[i];
    if (!patch.is_plane) continue;
    const Eigen::Vector3d point_m = to_from_from * patch.centre_m;
    const std::optional<Eigen::Vector2d> pixel = project(camera, point_m);
    if (!pixel) continue;
    const auto col = static_cast<Eigen::Index>(std::floor((pixel->x() + 0.5) / size_px));
    const auto row = static_cast<Eigen::Index>(std::floor((pixel->y() + 0.5) / size_px));
    if (row < 0 || col < 0 || row >= to.patches.rows() || col >= to.patches.cols()) continue;
    const Patch& other = to.patches(row, col);
    if (!other.is_plane) continue;
    if ((to_from_from.linear() * patch.normal).dot(other.normal) < same_direction) continue;
    const double distance_m = other.normal.dot(point_m - other.centre_m);
    if (std::abs(distance_m) < same_surface_m) {
      const double range_m = patch.centre_m.norm();
      distances.data()[i] = static_cast<float>(distance_m * std::min(1.0, far_m / range_m));
    }
  }
  return distances;
}

/// Sum and number of products.
struct Products {
  double sum = 0;
  double count = 0;

  /// Adds the products of an image with itself, moved by some rows and columns, after clipping.
  void add(const ImageF& image, float most, Eigen::Index rows, Eigen::Index cols) {
    for (Eigen::Index row = 0; row + rows < image.rows(); ++row) {
      for (Eigen::Index col = 0; col + cols < image.cols(); ++col) {
        const float one = image(row, col);
        const float other = image(row + rows, col + cols);
        if (std::isnan(one) || std::isnan(other)) continue;
        sum += double{std::clamp(one, -most, most)} * std::clamp(other, -most, most);
        ++count;
      }
    }
  }
};

}  // namespace

double view_disagreement_m(const std::vector<RangedFrame>& frames, const CameraModel& camera) {
  const PixelRays rays = pixel_rays(camera);
  const int size_px = patch_size_px(camera);
  std::vector<PlanarFrame> planar;
  for (const RangedFrame& frame : frames) {
    if (!frame.world_from_camera) continue;
    planar.push_back({patches_of(*frame.image, rays, size_px), *frame.world_from_camera});
  }
  std::vector<ImageF> pairs(planar.size() * planar.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < planar.size(); ++i) {
    for (std::size_t k = 0; k < planar.size(); ++k) {
      if (i == k) continue;
      pairs[i * planar.size() + k] = distances_m(planar[i], planar[k], camera, size_px);
    }
  }
  std::vector<float> magnitudes_m;
  for (const ImageF& distances : pairs) {
    for (const float distance_m : distances.reshaped()) {
      if (!std::isnan(distance_m)) magnitudes_m.push_back(std::abs(distance_m));
    }
  }
  constexpr std::size_t enough = 1000;
  if (magnitudes_m.size() < enough) return nan;
  constexpr double clipped_sigmas = 3;
  const auto most_m =
      static_cast<float>(clipped_sigmas * sigma_of_median_deviation * median(magnitudes_m));
  constexpr Eigen::Index next_but_one = 2;
  Products products;
  for (const ImageF& distances : pairs) {
    products.add(distances, most_m, next_but_one, 0);
    products.add(distances, most_m, 0, next_but_one);
  }
  return products.count > 0 ? std::sqrt(std::max(0.0, products.sum / products.count)) : nan;
}

}  // namespace tofmap
