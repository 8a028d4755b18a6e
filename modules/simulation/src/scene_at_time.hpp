// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>

#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// What rays meet at one time: the surface that does not move, which must outlive this object, and
/// what moves.
struct SceneAtTime {
  const RayScene* still = nullptr;
  std::shared_ptr<const RayScene> moving = {};  ///< null if nothing moving is in the scene

  /// The first hit of a ray, as RayScene::cast().
  std::optional<RayHit> cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                             double max_range_m) const {
    std::optional<RayHit> hit = still->cast(origin, direction, max_range_m);
    if (!moving) return hit;
    std::optional<RayHit> nearer =
        moving->cast(origin, direction, hit ? hit->range_m : max_range_m);
    if (!nearer) return hit;
    nearer->is_moving = true;
    return nearer;
  }
};

}  // namespace tofmap
