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

/// Adds a position of the camera in a map; the timestamp must be later than all before. The
/// position extends the newest stretch if that is in the same map, and begins a new stretch
/// otherwise.
void add_position(std::vector<Stretch>& stretches, int map, double timestamp_s,
                  const Eigen::Vector3d& position_m);

/// Tolerance of can_travel() for drift in both maps.
inline constexpr double travel_tolerance_m = 0.5;

/// Whether the camera can have moved between two maps if their relative pose is that of `join`
/// (whose edges are ignored): from the end of each stretch in one of these maps to the beginning of
/// the next stretch in the other one. The distance between them must be at most what the camera can
/// have moved at 3 m/s while no frame was registered (nobody carries a camera faster than that
/// through a building), plus the lengths of stretches in other maps, plus `tolerance_m`.
/// `stretches` are in the order of time.
bool can_travel(std::span<const Stretch> stretches, const MapJoin& join,
                double tolerance_m = travel_tolerance_m);

}  // namespace tofmap
