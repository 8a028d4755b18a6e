// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>

#include <tofmap/core/error.hpp>

namespace tofmap {

/// Grid coordinates have 21 bits per axis: with voxels of 1 cm they span 21 km.
inline constexpr int grid_axis_bits = 21;
inline constexpr std::int64_t grid_axis_half = std::int64_t{1} << (grid_axis_bits - 1);

/// Packs grid coordinates into one number, whose order is that of x, then y, then z. Throws
/// UsageError, which states the voxel size, if a coordinate does not fit.
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

/// The grid coordinates of a key.
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
