// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <Eigen/Core>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// Where a ray meets the surface first.
struct RayHit {
  double range_m = 0;
  double cos_incidence = 0;  ///< between the ray and the surface's normal, 0 … 1
  double reflectance = 0;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< of the surface, unit, to either side
};

/// A mesh prepared for exact ray casting (Embree). Queries may come from several threads.
class RayScene {
 public:
  /// Throws UsageError if the mesh has no triangle.
  explicit RayScene(const TriangleMesh& mesh);
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  /// The first hit within `max_range_m` along the unit vector `direction`, world frame.
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m) const;

  /// Range to the nearest point of the surface in any direction, at most `limit_m`.
  double clearance_m(const Eigen::Vector3d& point, double limit_m) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
};

}  // namespace tofmap
