// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/core/camera.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Smallest confidence of a range that tells of free space by itself: with a wrong wrap count it
/// looks like a thing that has moved by a wavelength.
constexpr float sure_confidence = 0.9F;

/// What a point in the world is to a keyframe.
enum class Observation {
  nothing,       ///< out of view, occluded, or at a pixel without a range
  agrees,        ///< on the surface
  sees_through,  ///< in front of what is seen at the pixel and around it
};

/// A cloud whose pose is known, prepared for testing many points against free space. The cloud
/// and the camera must outlive it.
class KeyframeView {
 public:
  /// `margin_m` is added to three standard deviations of a surface, along its normal, and to those
  /// of a point without a normal, along its ray.
  KeyframeView(const RegistrationTarget& seen, const CameraModel& camera, double margin_m);

  Observation judge(const Eigen::Vector3d& world_m) const;

 private:
  std::optional<float> share_before(int row, int col, const Eigen::Vector3f& point_m) const;
  bool is_free_around(int row, int col, const Eigen::Vector3f& point_m) const;

  Pose camera_from_world_;
  const SurfaceCloud& cloud_;
  const CameraModel& camera_;
  double margin_m_;
  float farthest_m_ = 0;
};

}  // namespace tofmap
