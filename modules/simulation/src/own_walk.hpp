// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "walk_ahead.hpp"

#include <optional>
#include <vector>

namespace tofmap {

/// Someone who walks to and fro on a straight line through free space, and leaves it to make way
/// for the camera.
class OwnWalk {
 public:
  /// Walks from one end of the line, points on the floor, to the other and back. `key` determines
  /// speed, 0.8 to 1.4 m/s, and phase.
  OwnWalk(const WalkSurroundings& around, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
          std::uint64_t key);

  /// The places on, beside and beyond the line on which the person can stand at a step. They cost
  /// the more, the farther they are from the wanted place, and the nearer the camera is.
  std::vector<WalkPlace> places(int step) const;

  Eigen::Vector3d middle() const { return (from_ + to_) / 2; }

 private:
  Eigen::Vector3d wanted(double time_s) const;

  const WalkSurroundings& around_;
  Eigen::Vector3d from_;
  Eigen::Vector3d to_;
  std::vector<Eigen::Vector3d> places_;  ///< free of what does not move
  double speed_m_per_s_;
  double phase_;  ///< of the walk there and back at the time 0, 0 … 1
};

/// The walk, among lines of 2 to 6 m through free space, that is largest and longest in the
/// picture, by a chance that `key` determines, and whose middle is 1.5 m or more away from those of
/// `others`. Empty if there is no such line.
std::optional<OwnWalk> find_own_walk(const WalkSurroundings& around,
                                     const std::vector<OwnWalk>& others, std::uint64_t key);

}  // namespace tofmap
