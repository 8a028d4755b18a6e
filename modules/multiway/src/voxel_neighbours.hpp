// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// For each point of a cloud that was downsampled, the other points at most two voxels away along
/// each axis.
class VoxelNeighbours {
 public:
  VoxelNeighbours() = default;
  VoxelNeighbours(std::span<const Eigen::Vector3f> points_m, double voxel_m);

  /// Indices of the neighbours of a point, in no particular order.
  std::span<const int> of(std::size_t point) const;

 private:
  std::vector<std::size_t> starts_;  ///< of each point in `indices_`, and the end of the last
  std::vector<int> indices_;
};

}  // namespace tofmap
