// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/camera_travel.hpp"

#include <cstddef>

namespace tofmap {
namespace {

constexpr double fastest_m_per_s = 3;

}  // namespace

void add_position(std::vector<Stretch>& stretches, int map, double timestamp_s,
                  const Eigen::Vector3d& position_m) {
  if (stretches.empty() || stretches.back().map != map) {
    stretches.push_back({map, timestamp_s, timestamp_s, position_m, position_m});
  }
  stretches.back().end_s = timestamp_s;
  stretches.back().end_m = position_m;
}

bool can_travel(std::span<const Stretch> stretches, const MapJoin& join, double tolerance_m) {
  const auto is_placed = [&](const Stretch& stretch) {
    return stretch.map == join.map || stretch.map == join.into;
  };
  const auto placed = [&](const Stretch& stretch, const Eigen::Vector3d& position_m) {
    return stretch.map == join.map ? Eigen::Vector3d(join.into_from_map * position_m) : position_m;
  };
  const Stretch* last = nullptr;  // the last one in one of both maps
  double within_m = tolerance_m;  // how far the camera may have moved since its end
  for (std::size_t i = 0; i < stretches.size(); ++i) {
    const Stretch& stretch = stretches[i];
    if (i > 0) within_m += fastest_m_per_s * (stretch.begin_s - stretches[i - 1].end_s);
    if (!is_placed(stretch)) {
      within_m += (stretch.end_m - stretch.begin_m).norm();
      continue;
    }
    if (last != nullptr && last->map != stretch.map) {
      const double moved_m = (placed(stretch, stretch.begin_m) - placed(*last, last->end_m)).norm();
      if (moved_m > within_m) return false;
    }
    last = &stretch;
    within_m = tolerance_m;
  }
  return true;
}

}  // namespace tofmap
