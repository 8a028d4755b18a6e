// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace boost::serialization {
class access;
}

namespace tofmap {

/// How far off a camera may be that is expected to go on as it went: the covariance of a Kalman
/// filter with constant velocity, of pose and velocity together. Where surfaces say nothing of a
/// direction for some frames, it tells how quickly what is known of that direction fades.
///
/// Poses are off by twists: rotation vector about the camera's centre, radians, and translation,
/// metres, both along the world's axes.
class MotionUncertainty {
 public:
  using Covariance = Eigen::Matrix<double, 6, 6>;

  /// How much turn and step between two frames may change from one to the next.
  MotionUncertainty(double rotation_sigma_rad, double translation_sigma_m);

  /// So many frames have passed, at least one, and surfaces tell this much of the pose.
  void learn(int frames, const Covariance& information);

  /// Of the last pose.
  Covariance of_pose() const { return joint_.topLeftCorner<6, 6>(); }

  /// The pose is known, and the camera stands.
  void reset();

  /// The world's axes have turned.
  void turn(const Eigen::Matrix3d& new_from_old);

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  using Joint = Eigen::Matrix<double, 12, 12>;

  Eigen::Matrix<double, 6, 1> change_sigmas_;
  Joint joint_ = Joint::Zero();  ///< pose first, then velocity in twists a frame
};

}  // namespace tofmap
