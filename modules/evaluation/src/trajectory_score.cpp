// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/trajectory_score.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <tofmap/core/image.hpp>

namespace tofmap {
namespace {

constexpr double max_time_gap_s = 0.02;

struct Matched {
  std::vector<double> timestamps_s;
  std::vector<Pose> estimate;
  std::vector<Pose> truth;
};

Matched match(const Trajectory& estimate, const Trajectory& truth) {
  Matched matched;
  for (const StampedPose& pose : estimate) {
    const auto gap = [&](const StampedPose& other) {
      return std::abs(other.timestamp_s - pose.timestamp_s);
    };
    const auto nearest = std::ranges::min_element(truth, {}, gap);
    if (nearest == truth.end() || gap(*nearest) >= max_time_gap_s) continue;
    matched.timestamps_s.push_back(pose.timestamp_s);
    matched.estimate.push_back(pose.world_from_camera);
    matched.truth.push_back(nearest->world_from_camera);
  }
  return matched;
}

/// The rotation and translation that minimise the squared distances of positions.
Pose align_positions(const Matched& matched) {
  const auto count = static_cast<Eigen::Index>(matched.estimate.size());
  Eigen::Matrix3Xd from(3, count);
  Eigen::Matrix3Xd to(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    from.col(i) = matched.estimate[static_cast<std::size_t>(i)].translation();
    to.col(i) = matched.truth[static_cast<std::size_t>(i)].translation();
  }
  constexpr bool with_scale = false;
  return Pose(Eigen::umeyama(from, to, with_scale));
}

/// Whether positions nearly lie on a line, so that they do not determine the rotation about it.
bool are_on_a_line(const std::vector<Pose>& poses) {
  Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = poses[i].translation();
  }
  positions.colwise() -= positions.rowwise().mean().eval();
  const Eigen::Matrix3d covariance =
      positions * positions.transpose() / static_cast<double>(poses.size());
  constexpr double least_extent_m = 0.1;  // position errors of 1 cm tilt the rest by 6 degrees
  const Eigen::Vector3d variances =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  return variances(1) < least_extent_m * least_extent_m;
}

/// The alignment of positions and of points 1 m from them along the axes of the camera.
Pose align_poses(const Matched& matched) {
  Matched points;
  const auto add = [](const Pose& pose, std::vector<Pose>& to) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side_m : {-1.0, 1.0}) {
        to.push_back(pose * Eigen::Translation3d(side_m * Eigen::Vector3d::Unit(axis)));
      }
    }
  };
  for (const Pose& pose : matched.estimate) add(pose, points.estimate);
  for (const Pose& pose : matched.truth) add(pose, points.truth);
  return align_positions(points);
}

std::vector<PoseError> errors_of(const Matched& matched, const Pose& truth_from_estimate) {
  std::vector<PoseError> errors;
  for (std::size_t i = 0; i < matched.estimate.size(); ++i) {
    const Eigen::Vector3d registered = truth_from_estimate * matched.estimate[i].translation();
    errors.push_back(
        {matched.timestamps_s[i], (registered - matched.truth[i].translation()).norm()});
  }
  return errors;
}

/// The length of the path from the first pose to each pose.
std::vector<double> path_lengths(const std::vector<Pose>& poses) {
  std::vector<double> lengths{0};
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths.push_back(lengths.back() +
                      (poses[i].translation() - poses[i - 1].translation()).norm());
  }
  return lengths;
}

void score_relative(const Matched& matched, const std::vector<double>& lengths,
                    TrajectoryScore& score) {
  double metres2 = 0;
  double degrees2 = 0;
  int count = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto end = std::ranges::lower_bound(lengths, lengths[i] + 1);
    if (end == lengths.end()) break;
    const auto j = static_cast<std::size_t>(end - lengths.begin());
    const Pose truth = matched.truth[i].inverse() * matched.truth[j];
    const Pose error = truth.inverse() * (matched.estimate[i].inverse() * matched.estimate[j]);
    const double degrees = rotation_angle_rad(Pose::Identity(), error) * 180 / std::numbers::pi;
    metres2 += error.translation().squaredNorm();
    degrees2 += degrees * degrees;
    ++count;
  }
  score.rpe_rmse_m_per_m = count > 0 ? std::sqrt(metres2 / count) : nan;
  score.rpe_rmse_deg_per_m = count > 0 ? std::sqrt(degrees2 / count) : nan;
}

}  // namespace

std::vector<PoseError> pose_errors(const Trajectory& estimate, const Trajectory& truth,
                                   const Pose& truth_from_estimate) {
  return errors_of(match(estimate, truth), truth_from_estimate);
}

std::optional<TrajectoryScore> score_trajectory(const Trajectory& estimate,
                                                const Trajectory& truth) {
  const Matched matched = match(estimate, truth);
  if (matched.estimate.size() < 3) return std::nullopt;
  TrajectoryScore score;
  score.matched = static_cast<int>(matched.estimate.size());
  score.truth_from_estimate =
      are_on_a_line(matched.truth) ? align_poses(matched) : align_positions(matched);
  double sum = 0;
  for (const PoseError& pose : errors_of(matched, score.truth_from_estimate)) {
    sum += pose.error_m * pose.error_m;
    score.ate_max_m = std::max(score.ate_max_m, pose.error_m);
  }
  score.ate_rmse_m = std::sqrt(sum / score.matched);
  const std::vector<double> lengths = path_lengths(matched.truth);
  score.length_m = lengths.back();
  score_relative(matched, lengths, score);
  return score;
}

}  // namespace tofmap
