// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tofmap {

/// Uncertainty of the pose of a camera that is assumed to move with constant velocity: the joint
/// covariance of pose and velocity of a Kalman filter. It grows in directions that the surfaces do
/// not constrain for some frames.
///
/// A pose error is a twist: rotation vector about the camera's centre, radians, then translation,
/// metres, both along the world's axes.
class MotionUncertainty {
 public:
  using Twist = Eigen::Matrix<double, 6, 1>;
  using Covariance = Eigen::Matrix<double, 6, 6>;

  /// The arguments are the largest standard deviations, per axis, of the change in frame-to-frame
  /// rotation and translation from one frame to the next. They hold until changes are noted.
  MotionUncertainty(double rotation_sigma_rad, double translation_sigma_m);

  /// Learns how steady the motion is from the change of the motion to a frame: the difference, over
  /// `frames` ≥ 1 frames, of the pose that was found from that which constant velocity predicts.
  /// `of_change` is its covariance. What counts is the change along directions in which it is known
  /// to a tenth of the largest standard deviations; without any, nothing is learned.
  void note_change(const Twist& change, const Covariance& of_change, int frames);

  /// Standard deviations of the change of the motion from one frame to the next: twice the root
  /// mean square of recent changes, but at least a tenth of the largest ones and at most these.
  /// Three equal values for rotation, then three for translation.
  Twist change_sigmas() const;

  /// Predicts over `frames` ≥ 1 frames, then updates with the information about the pose that the
  /// surfaces of the last of these frames give.
  void learn(int frames, const Covariance& information);

  /// Covariance of the error of the last pose.
  Covariance of_pose() const { return joint_.topLeftCorner<6, 6>(); }

  /// Sets all uncertainty to zero: the pose is known, and the camera stands still. Forgets the
  /// noted changes.
  void reset();

  /// The camera may already move at the first frame: sets the covariance of the velocity to that of
  /// three times the largest changes.
  void forget_velocity();

  /// Sets the covariance of the pose, as if it were measured from another place from now on. That
  /// of the velocity remains.
  void restart(const Covariance& of_pose = Covariance::Zero());

  /// Rotates the covariance into new axes of the world.
  void rotate(const Eigen::Matrix3d& new_from_old);

 private:
  friend struct SavedState;  // mapper_state.cpp

  using Joint = Eigen::Matrix<double, 12, 12>;

  Twist largest_sigmas_;
  Twist mean_squares_;           ///< of recent changes
  Joint joint_ = Joint::Zero();  ///< pose first, then velocity in twists per frame
};

}  // namespace tofmap
