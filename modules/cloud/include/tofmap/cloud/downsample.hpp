// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Replaces the points in each voxel of a grid by their mean. The result is in the order in which
/// voxels first occur in `points`. Grid coordinates have 64 bits per axis, since pcl::VoxelGrid,
/// with 32 bits for the whole grid, merges points of different voxels or fails for large clouds.
/// `voxel_m` is in the unit of the points. Throws UsageError if it is not positive, or so small
/// that doubles cannot represent the grid coordinates. Points must be finite, or it throws as well.
std::vector<Eigen::Vector3d> downsample(std::span<const Eigen::Vector3d> points, double voxel_m);

/// The smallest voxel size, within 10 %, with which downsample() leaves at most `count` points,
/// found by bisection; in the unit of the points. It is never less than 1e-5 of the extent of the
/// points. 1 if the points have no extent.
double voxel_for_count(std::span<const Eigen::Vector3d> points, std::size_t count);

/// Removes stray points: those more than twenty times as far from the middle of the cloud (the
/// median per axis) as 95 % of the points are. Returns the number of removed points.
std::size_t remove_strays(std::vector<Eigen::Vector3d>& points);

}  // namespace tofmap
