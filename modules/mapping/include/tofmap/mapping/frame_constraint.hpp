// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// What the registration of a frame with a keyframe tells of their relative pose (TargetEquations).
/// In single precision, since a map has several of these for each frame.
struct FrameConstraint {
  int keyframe = 0;                                                        ///< id
  Eigen::Isometry3f keyframe_from_camera = Eigen::Isometry3f::Identity();  ///< as it was found
  /// Information about the error of that pose: a rotation vector in radians, then a translation in
  /// metres, along the axes of the keyframe. It may have negative eigenvalues, where it is noise.
  Eigen::Matrix<float, 6, 6> information = Eigen::Matrix<float, 6, 6>::Zero();
  Eigen::Matrix<float, 6, 1> gradient = Eigen::Matrix<float, 6, 1>::Zero();
};

/// The constraints of a frame that was registered with keyframes, for each keyframe with which the
/// registration has equations.
std::vector<FrameConstraint> constraints_of(const RegistrationResult& registration,
                                            std::span<const Keyframe* const> keyframes);

}  // namespace tofmap
