// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/mapping/map_join.hpp>

namespace tofmap {

/// Frames that follow each other in time and were registered in the same map.
struct Stretch {
  int map = 0;
  double begin_s = 0;                                 ///< timestamp of the first frame
  double end_s = 0;                                   ///< timestamp of the last frame
  Eigen::Vector3d begin_m = Eigen::Vector3d::Zero();  ///< position of the camera at the first frame
  Eigen::Vector3d end_m = Eigen::Vector3d::Zero();    ///< position of the camera at the last frame
};

/// Adds the position of the camera in a map, later than all before, to the newest stretch if that
/// is of the same map, else as a stretch of its own.
void add_position(std::vector<Stretch>& stretches, int map, double timestamp_s,
                  const Eigen::Vector3d& position_m);

/// Tolerance of can_travel() for drift in both maps.
inline constexpr double travel_tolerance_m = 0.5;

/// Whether the camera can have travelled as it must have if two maps lie to each other as `join`
/// says (its edges do not matter): from the end of each stretch in one of these maps to the begin
/// of the next one in the other. Between them, it moved at 3 m/s at most while no frame was
/// registered, faster than a camera is carried through a building, and as far as it did in other
/// maps. `tolerance_m` more is tolerated. `stretches` are in the order of time.
bool can_travel(std::span<const Stretch> stretches, const MapJoin& join,
                double tolerance_m = travel_tolerance_m);

}  // namespace tofmap
