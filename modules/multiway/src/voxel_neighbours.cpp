// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "voxel_neighbours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

namespace tofmap {
namespace {

constexpr int reach_voxels = 2;

using Cell = std::array<int, 3>;

Cell cell_of(const Eigen::Vector3f& point_m, double voxel_m) {
  const Eigen::Array3d scaled = (point_m.cast<double>() / voxel_m).array().floor();
  return {static_cast<int>(scaled.x()), static_cast<int>(scaled.y()), static_cast<int>(scaled.z())};
}

}  // namespace

VoxelNeighbours::VoxelNeighbours(std::span<const Eigen::Vector3f> points_m, double voxel_m) {
  std::vector<std::pair<Cell, int>> cells;
  for (const Eigen::Vector3f& point : points_m) {
    cells.emplace_back(cell_of(point, voxel_m), static_cast<int>(cells.size()));
  }
  std::ranges::sort(cells);
  starts_.push_back(0);
  for (int i = 0; i < static_cast<int>(points_m.size()); ++i) {
    const auto [x, y, z] = cell_of(points_m[static_cast<std::size_t>(i)], voxel_m);
    for (int dx = -reach_voxels; dx <= reach_voxels; ++dx) {
      for (int dy = -reach_voxels; dy <= reach_voxels; ++dy) {
        const Cell last{x + dx, y + dy, z + reach_voxels};
        auto at = std::ranges::lower_bound(cells, Cell{x + dx, y + dy, z - reach_voxels},
                                           std::ranges::less(), &std::pair<Cell, int>::first);
        for (; at != cells.end() && at->first <= last; ++at) {
          if (at->second != i) indices_.push_back(at->second);
        }
      }
    }
    starts_.push_back(indices_.size());
  }
}

std::span<const int> VoxelNeighbours::of(std::size_t point) const {
  const std::span<const int> all = indices_;
  return all.subspan(starts_[point], starts_[point + 1] - starts_[point]);
}

}  // namespace tofmap
