// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include "walk_ahead.hpp"
#include "walker.hpp"

#include <vector>

namespace tofmap {

/// The people of a recording. There are fewer than the options ask for if people on paths of their
/// own do not find enough free space.
std::vector<Walker> walking_people(const WalkSurroundings& around, const SimulatorOptions& options);

}  // namespace tofmap
