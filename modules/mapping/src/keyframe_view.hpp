// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/pose_spread.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Smallest confidence of a range that tells of free space by itself: with a wrong wrap count it
/// looks like a thing that has moved by a wavelength.
constexpr float sure_confidence = 0.9F;

/// How what a keyframe sees relates to a point in the world.
enum class Observation {
  nothing,       ///< out of view, occluded, or at a pixel without a range
  agrees,        ///< on the surface
  sees_through,  ///< in front of what is seen at the pixel and around it
};

/// A cloud whose pose is known, prepared for testing many points against free space. The cloud
/// and the camera must outlive it.
class KeyframeView {
 public:
  /// Tolerated are `margin_m`, three standard deviations of the surface (along its normal, or along
  /// the ray if it has none), and three of `spread`, that of the relative pose of the cloud and the
  /// points.
  KeyframeView(const RegistrationTarget& seen, const CameraModel& camera, double margin_m,
               const PoseSpread& spread = {});

  Observation judge(const Eigen::Vector3d& world_m) const;

 private:
  std::optional<float> share_before(int row, int col, const Eigen::Vector3f& point_m) const;
  bool is_free_around(int row, int col, const Eigen::Vector3f& point_m) const;
  float tolerated_m(double sigma_m, const Eigen::Vector3f& point_m) const;

  Pose camera_from_world_;
  const SurfaceCloud& cloud_;
  const CameraModel& camera_;
  double margin_m_;
  double pose_sigma_m_;
  double pose_sigma_rad_;
  float farthest_m_ = 0;
};

}  // namespace tofmap
