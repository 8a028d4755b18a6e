// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "camera_steps.hpp"
#include "standing_space.hpp"
#include "walk_planner.hpp"

#include <cstdint>
#include <vector>

namespace tofmap {

struct SimulatorOptions;

/// What people plan their walks with.
struct WalkSurroundings {
  const RayScene& still;
  const StandingSpace& space;
  const CameraSteps& steps;
  const CameraModel& camera;
};

/// Smallest horizontal distance of the camera from the middle of a person.
inline constexpr double least_camera_gap_m = 0.65;

/// Height of the chest over the floor, which stands for a person in tests of visibility.
inline constexpr double chest_m = 1.2;

/// Someone who walks to and fro ahead of the camera and keeps its pace: in polar coordinates around
/// the camera, angle and range oscillate.
class WalkAhead {
 public:
  /// The walk of the person of this number, 0 for the nearest. `key` determines the phases.
  WalkAhead(const WalkSurroundings& around, const SimulatorOptions& options, int person,
            std::uint64_t key);

  /// The places around the camera at a step on which the person can stand. They cost the more, the
  /// farther they are from the wanted place, and if the camera does not see them.
  std::vector<WalkPlace> places(int step) const;

 private:
  const WalkSurroundings& around_;
  double range_m_;    ///< horizontal, from the camera, on average
  double half_rad_;   ///< largest angle to each side
  double period_s_;   ///< of the walk to and fro
  double phase_rad_;  ///< of the walk to and fro at the time 0
};

}  // namespace tofmap
