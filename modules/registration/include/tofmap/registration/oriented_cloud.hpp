// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Exact search for the nearest point (FLANN's kd-tree). nearest() may be called from several
/// threads at once.
class PointSearch {
 public:
  /// Builds the tree from a copy of the points. `points_m` must not be empty.
  explicit PointSearch(const std::vector<Eigen::Vector3f>& points_m);

  struct Neighbour {
    std::size_t index = 0;  ///< in `points_m`
    float squared_gap_m2 = 0;
  };

  /// The nearest point to `place_m`. Empty if no point is within `max_distance_m`. `place_m` must
  /// be finite.
  std::optional<Neighbour> nearest(const Eigen::Vector3f& place_m, double max_distance_m) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// Points on surfaces with unit normals and a search tree, all in the frame of the cloud.
struct OrientedCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;  ///< of each point, towards the viewpoint
  double voxel_m = 0;                    ///< typical spacing of the points
  PointSearch search;                    ///< over `points_m`

  std::size_t size() const { return points_m.size(); }
};

/// Smallest number of points that orient() makes a cloud of.
constexpr std::size_t least_oriented_points = 50;

/// Estimates a normal for each point from the covariance of its 20 nearest neighbours (PCL) and
/// orients it towards `viewpoint_m`. Points without a finite normal are dropped. Empty if fewer
/// than `least_oriented_points` remain.
std::optional<OrientedCloud> orient(std::span<const Eigen::Vector3d> points_m, double voxel_m,
                                    const Eigen::Vector3d& viewpoint_m);

}  // namespace tofmap
