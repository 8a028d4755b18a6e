// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include <Eigen/Core>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// The leaf of a door, and how it swings. World frame, z up.
struct Door {
  Eigen::Vector3d hinge_m = Eigen::Vector3d::Zero();  ///< the lower end of its axis
  double shut_rad = 0;    ///< direction from the hinge to the edge of the shut leaf, about z
  double side = 1;        ///< 1: opens counter-clockwise as seen from above, −1: clockwise
  double open_rad = 1.5;  ///< angle between the shut and the open leaf
  double height_m = 2;
  double reflectance = 0.6;
  bool is_open_at_first = false;
  std::vector<double> swings_s;  ///< when it begins to open or shut, in turn; swing_s or more apart

  static constexpr double width_m = 0.8;
  static constexpr double thickness_m = 0.04;
  static constexpr double swing_s = 1.8;      ///< time of opening or shutting
  static constexpr double off_wall_m = 0.06;  ///< from the wall to the middle of the shut leaf

  /// The angle between the leaf and the shut leaf, 0 … open_rad. It follows the smooth step
  /// 3t² − 2t³ while the door swings.
  double angle_at(double time_s) const;

  /// The horizontal direction from the hinge to the edge of the leaf at an angle.
  Eigen::Vector3d leaf_direction(double angle_rad) const;
};

/// Adds the leaf, with a handle on each side, as it is at a time.
void add_leaf(TriangleMesh& mesh, const Door& door, double time_s);

/// Adds the frame, which does not move: two jambs and a lintel in front of the wall.
void add_frame(TriangleMesh& mesh, const Door& door);

}  // namespace tofmap
