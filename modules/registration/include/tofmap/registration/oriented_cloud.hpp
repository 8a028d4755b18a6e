// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Finds nearest points exactly (FLANN's kd-tree). May be asked by several threads at once.
class PointSearch {
 public:
  explicit PointSearch(const std::vector<Eigen::Vector3f>& points_m);

  struct Neighbour {
    std::size_t index = 0;
    float squared_gap_m2 = 0;
  };

  /// The nearest point within `max_distance_m`; nothing if there is none. The place must be finite.
  std::optional<Neighbour> nearest(const Eigen::Vector3f& place_m, double max_distance_m) const;

 private:
  struct Tree;
  std::shared_ptr<const Tree> tree_;
};

/// Points on surfaces, in a frame of their own, with unit normals and a search tree.
struct OrientedCloud {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Eigen::Vector3f> normals;  ///< of each point, towards where it was seen from
  double voxel_m = 0;                    ///< their typical spacing
  PointSearch search;

  std::size_t size() const { return points_m.size(); }
};

/// No surface can be told from fewer points.
constexpr std::size_t least_oriented_points = 50;

/// Normals by the covariance of each point's 20 nearest neighbours (PCL), turned to `viewpoint_m`.
/// Points without a plane around them are left out; nothing if fewer than `least_oriented_points`
/// are left.
std::optional<OrientedCloud> orient(std::span<const Eigen::Vector3d> points_m, double voxel_m,
                                    const Eigen::Vector3d& viewpoint_m);

}  // namespace tofmap
