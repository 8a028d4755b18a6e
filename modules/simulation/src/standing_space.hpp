// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// The places near a camera path on which people can stand: floor that is free up to a person's
/// height, and that can be reached on foot from beneath the path. World frame, z up.
///
/// The floor is found by casting rays downwards. If they meet nothing beneath the whole path, the
/// floor is taken to be 1.5 m beneath the camera.
class StandingSpace {
 public:
  /// Explores the floor up to `reach_m` away from the path, on foot, and farther beneath a camera
  /// that is high above the floor.
  StandingSpace(const RayScene& still, const Trajectory& path, double reach_m);

  /// Whether rays find a floor beneath the path.
  bool has_floor() const { return has_floor_; }

  /// The height of the floor beneath a camera position, metres.
  double floor_beneath_m(const Eigen::Vector3d& camera_m) const;

  /// The point of the floor at a place near the floor, if a person can stand there.
  std::optional<Eigen::Vector3d> standing_place(const Eigen::Vector3d& place_m) const;

  /// Makes all places within `radius_m` of a point, horizontally, not free.
  void block(const Eigen::Vector3d& centre_m, double radius_m);

  /// Free places about `spacing_m` apart, on a grid.
  std::vector<Eigen::Vector3d> free_places(double spacing_m) const;

 private:
  struct Cell {
    Eigen::Vector3d middle_m;  ///< on the floor
    bool is_free = false;
    int steps = 0;  ///< from the path
  };
  static std::uint64_t key(int col, int row, double floor_m);
  std::optional<double> drop_m(const Eigen::Vector3d& from, double limit_m) const;
  Cell inspect(int col, int row, double near_floor_m, int steps) const;
  const Cell* find(int col, int row, double floor_m) const;
  void explore(const Trajectory& path, int max_steps);

  const RayScene& still_;
  double eye_height_m_ = 1.5;  ///< of the camera over the floor, the median along the path
  bool has_floor_ = false;
  std::map<std::uint64_t, Cell> cells_;  ///< sorted, so that their order is always the same
};

}  // namespace tofmap
