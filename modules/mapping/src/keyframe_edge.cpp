// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_edge.hpp"

#include <Eigen/LU>

namespace tofmap {
namespace {

/// Standard deviations of errors that neighbouring frames share, which the covariance of a
/// registration does not include.
constexpr double shared_sigma_m = 0.002;
constexpr double shared_sigma_rad = 0.0005;

}  // namespace

Eigen::Matrix<double, 6, 6> covariance_of(const Eigen::Matrix<double, 6, 6>& information) {
  constexpr double unseen_rad = 0.5;
  constexpr double unseen_m = 1;
  Eigen::Matrix<double, 6, 6> sum = information;
  sum.diagonal().head<3>().array() += 1 / (unseen_rad * unseen_rad);
  sum.diagonal().tail<3>().array() += 1 / (unseen_m * unseen_m);
  return sum.inverse();
}

Eigen::Matrix<double, 6, 6> with_shared_errors(const Eigen::Matrix<double, 6, 6>& covariance) {
  PoseEdge edge;
  edge.covariance = covariance;
  widen(edge, shared_sigma_rad, shared_sigma_m);
  return edge.covariance;
}

PoseEdge edge_of(const Keyframe& from, int to, const Pose& world_from_camera,
                 const Eigen::Matrix<double, 6, 6>& covariance) {
  PoseEdge edge;
  edge.from = from.id;
  edge.to = to;
  edge.from_from_to = from.world_from_camera.inverse() * world_from_camera;
  // The covariance of a registration is along the world's axes, that of an edge along those of
  // `from`.
  edge.covariance =
      with_shared_errors(rotated(covariance, from.world_from_camera.linear().transpose()));
  return edge;
}

PoseEdge loop_edge(const Keyframe& from, int to, const RegistrationResult& result) {
  PoseEdge edge =
      edge_of(from, to, result.world_from_camera, covariance_of(result.target_information.front()));
  edge.may_be_wrong = true;
  return edge;
}

}  // namespace tofmap
