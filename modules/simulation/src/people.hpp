// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "walker.hpp"

#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

struct SimulatorOptions;

/// The people of a recording. `camera` are the poses of the camera, with increasing timestamps.
std::vector<Walker> walking_people(const RayScene& still, const Trajectory& camera,
                                   const SimulatorOptions& options);

}  // namespace tofmap
