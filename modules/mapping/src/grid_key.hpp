// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include <tofmap/core/error.hpp>

namespace tofmap {

/// Grid coordinates of 21 bits an axis: at voxels of 1 cm they span 21 km.
inline constexpr int grid_axis_bits = 21;
inline constexpr std::int64_t grid_axis_half = std::int64_t{1} << (grid_axis_bits - 1);

/// One number for a place in a grid; their order is that of x, then y, then z. Throws UsageError
/// that names the voxels' size if the place is too far out.
inline std::int64_t grid_key(const Eigen::Vector3i& place, double voxel_m) {
  std::int64_t packed = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (place[axis] < -grid_axis_half || place[axis] >= grid_axis_half) {
      throw UsageError("map.voxel_m: " + std::to_string(voxel_m) +
                       " m is too small for a map of this extent; choose larger voxels");
    }
    packed = (packed << grid_axis_bits) | (place[axis] + grid_axis_half);
  }
  return packed;
}

inline Eigen::Vector3i grid_place(std::int64_t key) {
  constexpr std::int64_t mask = (std::int64_t{1} << grid_axis_bits) - 1;
  Eigen::Vector3i place;
  for (int axis = 2; axis >= 0; --axis) {
    place[axis] = static_cast<int>((key & mask) - grid_axis_half);
    key >>= grid_axis_bits;
  }
  return place;
}

}  // namespace tofmap
