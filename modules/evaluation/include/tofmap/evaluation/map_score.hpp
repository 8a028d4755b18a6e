// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// The true surface as the camera could see it: true ranges, put where the camera truly was, one
/// point a voxel of 4 cm (the first), in the world frame of the true poses. Points are kept
/// relative to an origin near them, so that a national grid costs them no digits.
class ReferenceSurface {
 public:
  ReferenceSurface() = default;
  explicit ReferenceSurface(const Eigen::Vector3d& origin_m) : origin_m_(origin_m) {}

  /// Adds every second pixel, in both axes, of a frame's true radial ranges. The pose is one of the
  /// world, not relative to the origin.
  void add(const ImageF& range_truth_m, const PixelRays& rays, const Pose& world_from_camera);

  /// In the world frame.
  const Eigen::Vector3d& origin_m() const { return origin_m_; }

  /// Relative to the origin.
  const std::vector<Eigen::Vector3f>& points() const { return points_; }

 private:
  Eigen::Vector3d origin_m_ = Eigen::Vector3d::Zero();
  std::unordered_map<std::int64_t, std::size_t> voxels_;
  std::vector<Eigen::Vector3f> points_;
};

/// An origin near most of the positions of a trajectory: their median by coordinate, in whole
/// metres, so that voxels lie alike wherever the world's origin is. Zero of an empty one.
Eigen::Vector3d origin_near(const Trajectory& poses);

/// From here on points of a map are not only inexact, but wrong.
inline constexpr double far_error_m = 0.2;

/// How right a map is.
struct MapScore {
  double accuracy_m = 0;   ///< mean distance of map points to the true surface, each at most 5 m
  double far_percent = 0;  ///< map points more than far_error_m off
  double completeness_percent = 0;  ///< true points with a map point within 0.1 m
  std::vector<float> errors_m;      ///< of each point of the map, as map_errors_m finds them
};

/// How far each point of a map is from the true surface, metres; `truth_from_map` moves it into the
/// frame of the reference. Near the reference (0.1 m) the distance is taken along its normal, so
/// that its sampling does not count as error. Errors of more than `most_m` are `most_m`: far points
/// take long to place. Throws UsageError if the reference is empty, or `most_m` not positive.
std::vector<float> map_errors_m(const MapCloud& map, const Pose& truth_from_map,
                                const ReferenceSurface& reference,
                                double most_m = std::numeric_limits<double>::infinity());

/// Scores a map by these errors. An empty map has an accuracy of NaN. Throws UsageError if the
/// reference is empty.
MapScore score_map(const MapCloud& map, const Pose& truth_from_map,
                   const ReferenceSurface& reference);

}  // namespace tofmap
