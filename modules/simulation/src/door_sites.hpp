// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "camera_steps.hpp"
#include "standing_space.hpp"

#include <vector>

#include <tofmap/simulation/door.hpp>

namespace tofmap {

/// Finds places for `count` doors on the walls that the camera sees. There, a leaf hangs flat in
/// front of a wall, swings freely, and always stays 0.35 m or more away from the path of the
/// camera. Doors are hung where they are largest and longest in the picture, by a chance that
/// `seed` determines, and 2 m or more apart. They swing while the camera sees them. There are fewer
/// doors if walls lack the space.
std::vector<Door> hang_doors(const RayScene& still, const StandingSpace& space,
                             const CameraSteps& steps, const CameraModel& camera, int count,
                             int seed);

}  // namespace tofmap
