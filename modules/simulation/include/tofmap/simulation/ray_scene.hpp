// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// The first point at which a ray meets the surface.
struct RayHit {
  double range_m = 0;        ///< from the origin of the ray
  double cos_incidence = 0;  ///< cosine of the angle between ray and surface normal, 0 … 1
  double reflectance = 0;    ///< 0 … 1
  /// Unit normal of the surface, world frame. It may point to either side.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  bool is_moving = false;  ///< whether the surface belongs to what moves in the scene
};

/// A mesh prepared for exact ray casting (Embree). Queries may come from several threads at the
/// same time.
class RayScene {
 public:
  /// Copies the mesh. Throws UsageError if it has no triangle.
  explicit RayScene(const TriangleMesh& mesh);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// The first hit of a ray within `max_range_m`. Origin, in metres, and unit vector `direction`
  /// are in the world frame. Empty if the ray meets no surface.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m) const;

  /// The distance from `point`, in metres and in the world frame, to the nearest point of the
  /// surface in any direction; `limit_m` if that is farther away.
  double clearance_m(const Eigen::Vector3d& point, double limit_m) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace tofmap
