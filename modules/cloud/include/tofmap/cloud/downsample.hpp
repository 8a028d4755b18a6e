// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// The mean of the points in each voxel of a grid, in the order in which voxels are first met. Any
/// size of voxels goes with any extent: places are counted in 64 bits (pcl::VoxelGrid, with 32 bits
/// for the whole grid, merges points of different places, or gives up). Throws UsageError if the
/// voxels are not positive or smaller than what doubles can tell apart at that extent.
std::vector<Eigen::Vector3d> downsample(std::span<const Eigen::Vector3d> points, double voxel_m);

/// The size of voxels, within a tenth, that leaves about so many of the points, however many there
/// are: found by halving intervals. Fewer points than that give the smallest voxels that merge any.
double voxel_for_count(std::span<const Eigen::Vector3d> points, std::size_t count);

/// Takes out points that lie so far off, twenty times as far from the middle as the outermost
/// twentieth begins, that they are none of what was recorded. Returns how many.
std::size_t remove_strays(std::vector<Eigen::Vector3d>& points);

}  // namespace tofmap
