// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/motion_uncertainty.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tofmap {

MotionUncertainty::MotionUncertainty(double rotation_sigma_rad, double translation_sigma_m) {
  change_sigmas_ << Eigen::Vector3d::Constant(rotation_sigma_rad),
      Eigen::Vector3d::Constant(translation_sigma_m);
}

void MotionUncertainty::learn(int frames, const Covariance& information) {
  Joint step = Joint::Identity();
  step.topRightCorner<6, 6>().diagonal().setConstant(frames);
  // A change of the motion between frames changes pose and velocity by the same twist.
  const Covariance change = (frames * change_sigmas_).cwiseAbs2().asDiagonal();
  const Joint expected = step * joint_ * step.transpose() + change.replicate<2, 2>();
  const Covariance of_pose = expected.topLeftCorner<6, 6>();
  const Covariance known = (of_pose.inverse() + information).inverse();
  // The update of the pose also updates the velocity through their correlation.
  const Eigen::Matrix<double, 6, 12> gain =
      of_pose.ldlt().solve(Eigen::Matrix<double, 6, 12>(expected.topRows<6>()));
  joint_ = expected - gain.transpose() * (of_pose - known) * gain;
  joint_ = (0.5 * (joint_ + joint_.transpose())).eval();
}

void MotionUncertainty::reset() { joint_.setZero(); }

void MotionUncertainty::restart() {
  joint_.topRows<6>().setZero();
  joint_.leftCols<6>().setZero();
}

void MotionUncertainty::rotate(const Eigen::Matrix3d& new_from_old) {
  Joint rotation = Joint::Zero();
  for (int i = 0; i < rotation.rows(); i += 3) rotation.block<3, 3>(i, i) = new_from_old;
  joint_ = (rotation * joint_ * rotation.transpose()).eval();
}

}  // namespace tofmap
