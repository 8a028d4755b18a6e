// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// Number of loops that tell against a map: those that the last fit has rejected, except for loops
/// that changes explain. Between recordings, a keyframe may fit to what was moved, or to a wall
/// instead of the cupboard that stood before it. A change explains a loop if at least 5 % of the
/// surface of one of its keyframes is within two voxels of what has changed between them. Changes
/// explain nothing if the fit rejects at least half of the loops between recordings: then a wrong
/// join may have made the changes.
int contradicted_loops(const MapContent& content);

}  // namespace tofmap
