// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "relative_measurement.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// What a measurement tells along the directions that it constrains.
struct ReliablePart {
  Matrix6d information;
  Vector6d gradient;
};

ReliablePart reliable_part(const Matrix6d& information, const Vector6d& gradient) {
  constexpr double lever_m = 3;  // rotations count by the motion of points at this range
  Vector6d scale;
  scale << Eigen::Vector3d::Constant(1 / lever_m), Eigen::Vector3d::Ones();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(
      Matrix6d(scale.asDiagonal() * information * scale.asDiagonal()));
  const Matrix6d directions = scale.cwiseInverse().asDiagonal() * solver.eigenvectors();
  const Vector6d slopes = solver.eigenvectors().transpose() * scale.asDiagonal() * gradient;
  Vector6d kept = Vector6d::Zero();
  for (int i = 0; i < kept.size(); ++i) {
    const double curvature = solver.eigenvalues()[i];
    if (std::abs(slopes[i]) < curvature * most_translation_error_m) kept[i] = 1;
  }
  return {
      directions * solver.eigenvalues().cwiseProduct(kept).asDiagonal() * directions.transpose(),
      directions * slopes.cwiseProduct(kept)};
}

}  // namespace

RelativeMeasurement measured_by(const FrameConstraint& constraint) {
  return {constraint.keyframe, Pose(constraint.keyframe_from_camera.cast<double>()),
          constraint.information.cast<double>(), constraint.gradient.cast<double>()};
}

bool is_small(const Vector6d& twist) {
  constexpr double most_rotation_rad = 0.05;
  return twist.head<3>().norm() <= most_rotation_rad &&
         twist.tail<3>().norm() <= most_translation_error_m;
}

Vector6d error_of(const RelativeMeasurement& measurement, const Pose& world_from_keyframe,
                  const Pose& pose) {
  return twist_between(world_from_keyframe * measurement.keyframe_from_pose, pose);
}

RelativeTerm term_of(const RelativeMeasurement& measurement, const Pose& world_from_keyframe,
                     const Pose& pose) {
  const Eigen::Matrix3d axes = world_from_keyframe.linear();
  const auto [information, gradient] = reliable_part(rotated(measurement.information, axes),
                                                     rotated_twist(measurement.gradient, axes));
  return {
      .keyframe = measurement.keyframe,
      .information = information,
      .gradient = gradient + information * error_of(measurement, world_from_keyframe, pose),
      .twist_by_keyframe = twist_at_offset(pose.translation() - world_from_keyframe.translation())};
}

}  // namespace tofmap
