// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/motion_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace tofmap {
namespace {

/// How many times larger than recent changes the next ones may be, as a standard deviation.
constexpr double margin = 2;

/// Changes are not taken to be smaller than this share of the largest ones: a camera that is held
/// still may be moved.
constexpr double least_share = 0.1;

}  // namespace

MotionUncertainty::MotionUncertainty(double rotation_sigma_rad, double translation_sigma_m) {
  largest_sigmas_ << Eigen::Vector3d::Constant(rotation_sigma_rad),
      Eigen::Vector3d::Constant(translation_sigma_m);
  mean_squares_ = largest_sigmas_.cwiseAbs2();
}

void MotionUncertainty::note_change(const Twist& change, const Covariance& of_change, int frames) {
  constexpr double share_of_newest = 0.05;
  constexpr int axes = 3;
  for (const int first : {0, axes}) {
    const double certain = least_share * largest_sigmas_[first];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> spread(
        of_change.block<axes, axes>(first, first));
    double sum = 0;
    int count = 0;
    for (int i = 0; i < axes; ++i) {
      if (spread.eigenvalues()[i] > certain * certain) continue;
      const double along = spread.eigenvectors().col(i).dot(change.segment<axes>(first)) / frames;
      sum += along * along;
      ++count;
    }
    if (count == 0) continue;
    auto squares = mean_squares_.segment<axes>(first).array();
    squares += share_of_newest * (sum / count - squares);
  }
}

MotionUncertainty::Twist MotionUncertainty::change_sigmas() const {
  return (margin * mean_squares_.cwiseSqrt())
      .cwiseMax(least_share * largest_sigmas_)
      .cwiseMin(largest_sigmas_);
}

void MotionUncertainty::learn(int frames, const Covariance& information) {
  Joint step = Joint::Identity();
  step.topRightCorner<6, 6>().diagonal().setConstant(frames);
  // A change of the motion between frames changes pose and velocity by the same twist.
  const Covariance change = (frames * change_sigmas()).cwiseAbs2().asDiagonal();
  const Joint expected = step * joint_ * step.transpose() + change.replicate<2, 2>();
  const Covariance of_pose = expected.topLeftCorner<6, 6>();
  const Covariance known = (of_pose.inverse() + information).inverse();
  // The update of the pose also updates the velocity through their correlation.
  const Eigen::Matrix<double, 6, 12> gain =
      of_pose.ldlt().solve(Eigen::Matrix<double, 6, 12>(expected.topRows<6>()));
  joint_ = expected - gain.transpose() * (of_pose - known) * gain;
  joint_ = (0.5 * (joint_ + joint_.transpose())).eval();
}

void MotionUncertainty::reset() {
  joint_.setZero();
  mean_squares_ = largest_sigmas_.cwiseAbs2();
}

void MotionUncertainty::forget_velocity() {
  constexpr double times = 3;
  joint_.bottomRightCorner<6, 6>() = (times * largest_sigmas_).cwiseAbs2().asDiagonal();
}

void MotionUncertainty::restart(const Covariance& of_pose) {
  joint_.topRows<6>().setZero();
  joint_.leftCols<6>().setZero();
  joint_.topLeftCorner<6, 6>() = of_pose;
}

void MotionUncertainty::rotate(const Eigen::Matrix3d& new_from_old) {
  Joint rotation = Joint::Zero();
  for (int i = 0; i < rotation.rows(); i += 3) rotation.block<3, 3>(i, i) = new_from_old;
  joint_ = (rotation * joint_ * rotation.transpose()).eval();
}

}  // namespace tofmap
