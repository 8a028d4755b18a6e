// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/registration/oriented_cloud.hpp>
#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {

/// Whether points of a cloud, which the sensor of another cloud saw through, may be the pane of a
/// window, a blind or a curtain before it. They may if
///  - they lie on a plane, within half a voxel;
///  - they are at most three metres wide and high;
///  - surfaces that both clouds show surround them: around their middle, no gap between such points
///    is wider than 40 degrees. The points are parallel to the plane, at most a quarter of a metre
///    before or behind it, and at most `reach_m` beside it.
/// An open door reaches down to the floor, where it has no frame, and is no window.
///
/// `region` are indices of the cloud's points, `sights` what the other cloud shows at all of them.
bool may_be_window(const OrientedCloud& cloud, std::span<const int> region,
                   std::span<const Sight> sights, double reach_m);

}  // namespace tofmap
