// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "motion_terms.hpp"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tofmap {

/// What is known of a pose relative to that of a keyframe, linearised about the present poses: the
/// cost of an error e of the pose is e·A·e / 2 + g·e, with A the information and g the gradient.
/// Twists (twist_between()) are along the axes of the world.
struct RelativeTerm {
  int keyframe = 0;
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
  /// Twist of the pose by a twist of the keyframe that moves it along (twist_at_offset()).
  Eigen::Matrix<double, 6, 6> twist_by_keyframe = Eigen::Matrix<double, 6, 6>::Identity();
};

/// The equations of a frame alone, by the sum of its terms.
class FrameEquations {
 public:
  explicit FrameEquations(std::span<const RelativeTerm> terms);

  /// Whether the terms determine the frame, given the keyframes.
  bool are_regular() const { return (information_.vectorD().array() > 0).all(); }
  const Eigen::LDLT<Eigen::Matrix<double, 6, 6>>& information() const { return information_; }
  const Eigen::Matrix<double, 6, 1>& gradient() const { return gradient_; }

 private:
  Eigen::LDLT<Eigen::Matrix<double, 6, 6>> information_;
  Eigen::Matrix<double, 6, 1> gradient_ = Eigen::Matrix<double, 6, 1>::Zero();
};

/// The linear least squares problem of the corrections of poses, as twists along the axes of the
/// world: first those of all keyframes, by their ids, then those of other frames.
class CorrectionSystem {
 public:
  /// `is_held`: for each pose, whether it stays where it is.
  explicit CorrectionSystem(const std::vector<bool>& is_held);

  /// Adds what is known of a pose relative to a keyframe.
  void add(int pose, const RelativeTerm& term);

  /// Adds what is known of the motion through three poses.
  void add_motion(const std::array<int, 3>& poses, const MotionTerm& term);

  /// Adds what a frame tells about keyframes: its terms, from which the pose of the frame is
  /// eliminated (Schur complement). `equations` are of the same terms, and must be regular.
  void add_frame(std::span<const RelativeTerm> terms, const FrameEquations& equations);

  /// The corrections, six for each pose, zero if it is held or if nothing is known of it. Empty
  /// if they cannot be computed, since numbers are too large.
  std::optional<Eigen::VectorXd> solve() const;

 private:
  void add(int row, int column, const Eigen::Matrix<double, 6, 6>& block);
  void add(int row, const Eigen::Matrix<double, 6, 1>& gradient);

  std::vector<int> unknown_of_;  ///< for each pose, its place in the system; −1 if it is held
  /// By row and column; of those beside the diagonal, only the lower ones.
  std::map<std::pair<int, int>, Eigen::Matrix<double, 6, 6>> blocks_;
  Eigen::VectorXd gradient_;
};

/// The correction of a frame, given those of the keyframes.
Eigen::Matrix<double, 6, 1> frame_correction(std::span<const RelativeTerm> terms,
                                             const FrameEquations& equations,
                                             const Eigen::VectorXd& of_keyframes);

}  // namespace tofmap
