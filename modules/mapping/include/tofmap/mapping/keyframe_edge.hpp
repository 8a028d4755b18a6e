// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// The covariance of a pose relative to a keyframe, given the information that a registration has
/// from the surfaces of that keyframe. Along directions without information, the standard
/// deviations are 1 m and 0.5 rad, since registration would not have found the keyframe from
/// farther away.
Eigen::Matrix<double, 6, 6> covariance_of(const Eigen::Matrix<double, 6, 6>& information);

/// A covariance of a pose with the errors that neighbouring frames share, which registration cannot
/// measure.
Eigen::Matrix<double, 6, 6> with_shared_errors(const Eigen::Matrix<double, 6, 6>& covariance);

/// The edge of the pose graph from a registration of keyframe `to` with keyframe `from`.
/// `covariance` is that of the pose error, along the world's axes. That of the edge is along the
/// axes of `from`, and increased by the errors that neighbouring frames share, which registration
/// cannot measure.
PoseEdge edge_of(const Keyframe& from, int to, const Pose& world_from_camera,
                 const Eigen::Matrix<double, 6, 6>& covariance);

/// The loop constraint from a registration of keyframe `to` near keyframe `from`, which was the
/// first target. Its covariance comes from what the surfaces of `from` alone constrain.
PoseEdge loop_edge(const Keyframe& from, int to, const RegistrationResult& result);

}  // namespace tofmap
