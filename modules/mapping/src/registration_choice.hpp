// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/odometry.hpp>
#include <tofmap/mapping/pose_spread.hpp>
#include <tofmap/mapping/verification.hpp>

namespace tofmap {

/// Whether two poses are within a distance and an angle of each other.
inline bool are_near(const Pose& one, const Pose& other, double distance_m, double angle_rad) {
  return (one.translation() - other.translation()).norm() < distance_m &&
         rotation_angle_rad(one, other) < angle_rad;
}

/// Whether a registration explains at least 10 % more than another one (support()).
inline bool is_clearly_better(const RegistrationResult& one, const RegistrationResult& other) {
  constexpr double clear_factor = 1.1;
  return support(one) > clear_factor * support(other);
}

/// The information about the pose from the surfaces of all targets of a registration.
inline Eigen::Matrix<double, 6, 6> information_of(const RegistrationResult& result) {
  Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
  for (const Eigen::Matrix<double, 6, 6>& of_target : result.target_information) sum += of_target;
  return sum;
}

/// Where a camera that goes on as from `before_last` to `last` is after `share` of the time between
/// these. The motion is repeated along the axes of the camera, not along those of the world.
inline Pose at_constant_velocity(const Pose& before_last, const Pose& last, double share) {
  return last * interpolate(Pose::Identity(), before_last.inverse() * last, share);
}

/// Whether a pose relative to the keyframes around it is so uncertain that its frame should become
/// a keyframe: between keyframes that see more, the path is corrected only at keyframes.
inline bool is_uncertain(const PoseSpread& spread, const OdometryOptions& options) {
  constexpr double most_share = 0.2;
  return spread.translation_sigma_m() > most_share * options.keyframe_translation_m;
}

}  // namespace tofmap
