// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "correction_system.hpp"
#include "tofmap/mapping/frame_constraint.hpp"

#include <Eigen/Core>

#include <tofmap/core/frame.hpp>

namespace tofmap {

/// How far a registration is believed: it is linear up to small errors only.
inline constexpr double most_translation_error_m = 0.1;

/// What was measured of a pose relative to a keyframe. Twists are along the axes of the keyframe.
struct RelativeMeasurement {
  int keyframe = 0;  ///< id
  Pose keyframe_from_pose = Pose::Identity();
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
};

RelativeMeasurement measured_by(const FrameConstraint& constraint);

/// Whether a twist is at most most_translation_error_m and 0.05 rad.
bool is_small(const Eigen::Matrix<double, 6, 1>& twist);

/// The twist from where a keyframe at this pose puts the other pose to where that is, along the
/// axes of the world.
Eigen::Matrix<double, 6, 1> error_of(const RelativeMeasurement& measurement,
                                     const Pose& world_from_keyframe, const Pose& pose);

/// The term of a measurement at these poses. It is that of the directions which the measurement
/// constrains: with positive information, and a minimum at most most_translation_error_m away. The
/// rest is noise.
RelativeTerm term_of(const RelativeMeasurement& measurement, const Pose& world_from_keyframe,
                     const Pose& pose);

}  // namespace tofmap
