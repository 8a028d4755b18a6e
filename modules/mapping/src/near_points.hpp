// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "grid_key.hpp"

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>

namespace tofmap {

/// Search for the points of a map within a fixed distance.
class NearPoints {
 public:
  /// `map` must outlive the search.
  NearPoints(const MapCloud& map, float reach_m) : map_(map), reach_m_(reach_m) {
    for (std::size_t i = 0; i < map.size(); ++i) cells_[key(cell_of(map[i]))].push_back(i);
  }

  /// Calls a function with the index of each point within `reach_m` of a point. Ends early, and
  /// returns true, if it returns true.
  template <class Function>
  bool any_near(const MapPoint& point, const Function& function) const {
    const Eigen::Vector3i middle = cell_of(point);
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const auto cell = cells_.find(key(middle + Eigen::Vector3i(x, y, z)));
          if (cell == cells_.end()) continue;
          for (const std::size_t i : cell->second) {
            const float gap_m = (map_[i].getVector3fMap() - point.getVector3fMap()).norm();
            if (gap_m <= reach_m_ && function(i)) return true;
          }
        }
      }
    }
    return false;
  }

 private:
  Eigen::Vector3i cell_of(const MapPoint& point) const {
    return (point.getVector3fMap() / reach_m_).array().floor().cast<int>();
  }
  std::int64_t key(const Eigen::Vector3i& cell) const { return grid_key(cell, reach_m_); }

  const MapCloud& map_;
  float reach_m_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace tofmap
