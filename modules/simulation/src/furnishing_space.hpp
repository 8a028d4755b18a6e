// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "upright_box.hpp"

#include <optional>
#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/camera_path.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// Where a path leads and what the camera looks at from there.
struct SampledPath {
  std::vector<Eigen::Vector3d> places_m;  ///< 5 cm apart or less where the path is not very long
  std::vector<Pose> views;                ///< evenly spaced in the parameter of the path
};

SampledPath sampled(const CameraPath& path);

/// The space in which furniture can be put into a scene: free floor that the camera sees and that
/// its path leaves free.
class FurnishingSpace {
 public:
  /// Both arguments must outlive the object.
  FurnishingSpace(const TriangleMesh& surface, const SampledPath& path);

  /// The height of the floor beneath the path. Empty if there is none.
  const std::optional<double>& floor_m() const { return floor_m_; }

  /// The height of the floor beneath a box, if it is even and close to that beneath the path.
  std::optional<double> floor_beneath_m(const UprightBox& box) const;

  /// Whether a box on the floor keeps 0.5 m away from the path. If the camera is carried through
  /// the scene, less than 2.5 m above the floor, then so far from whoever carries it.
  bool is_clear_of_path(const UprightBox& box) const;

  /// Whether a box on the floor keeps 2 cm away from the surface. What rises less than 5 cm from
  /// the floor is no obstacle.
  bool is_free(const UprightBox& box) const;

  /// The share of the points that the camera sees from two or more places of its path.
  double seen_share(const std::vector<Eigen::Vector3d>& points_m) const;

 private:
  bool sees(const Pose& world_from_camera, const Eigen::Vector3d& point_m) const;

  const TriangleMesh& surface_;
  const SampledPath& path_;
  RayScene rays_;
  std::optional<double> floor_m_;
};

}  // namespace tofmap
