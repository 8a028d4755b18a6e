// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "walk_planner.hpp"

#include <optional>
#include <vector>

#include <tofmap/simulation/person.hpp>

namespace tofmap {

/// A person who walks: the posture at evenly spaced times.
class Walker {
 public:
  /// A person who is at `walk[i]` at the time `start_s + i * step_s`. The person looks in the
  /// direction of the walk, turns at a limited rate, and swings legs and arms with the speed.
  Walker(const PersonLook& look, const WalkedPlaces& walk, double start_s, double step_s);

  const PersonLook& look() const { return look_; }

  /// The posture at a time. Empty while the person is not in the scene. Before the first and after
  /// the last time, the person stands still.
  std::optional<PersonStance> stance_at(double time_s) const;

 private:
  PersonLook look_;
  double start_s_;
  double step_s_;
  std::vector<std::optional<PersonStance>> stances_;
  std::vector<Eigen::Vector3d> velocities_;  ///< metres per second
};

}  // namespace tofmap
