// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// A point on the floor where a person could be at one time.
struct WalkPlace {
  Eigen::Vector3d foot_m;
  double cost_per_s = 0;  ///< how undesirable it is to be there
};

/// The cost per second of being `off_m` away from the wanted place: the square of off_m / 0.2 m
/// near by, and proportional to it farther away.
double cost_of_offset(double off_m);

/// Where a person is at evenly spaced times. Empty while the person is not in the scene.
using WalkedPlaces = std::vector<std::optional<Eigen::Vector3d>>;

/// The cheapest walk through one of `places(i)` at each of `steps` times, `step_s` apart
/// (Viterbi's algorithm). Walking costs (speed / 1.5 m/s)² per second, and nobody walks faster than
/// 3 m/s. A person who finds no place leaves the scene, which costs more than a bad place.
WalkedPlaces cheapest_walk(int steps, double step_s,
                           const std::function<std::vector<WalkPlace>(int step)>& places);

/// Smooths a walk: moves each place towards the middle between the place before and the place
/// after, wherever `is_allowed`, again and again.
void smooth_walk(WalkedPlaces& walk,
                 const std::function<bool(int step, const Eigen::Vector3d& foot_m)>& is_allowed);

}  // namespace tofmap
