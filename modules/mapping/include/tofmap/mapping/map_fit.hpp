// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include <tofmap/mapping/loop_fit.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// Adds a loop constraint to a map. fit_map() decides whether it is used.
void add_loop(MapContent& content, const PoseEdge& edge);

/// Moves the keyframes of a map to where its edges fit best (fit_loops()). The first `held` ones
/// stay where they are.
LoopFit fit_poses(MapContent& content, const LoopOptions& options, std::size_t held = 0);

/// The same, and decides which loops are used, by which it connects keyframes.
void fit_map(MapContent& content, const LoopOptions& options, std::size_t held = 0);

}  // namespace tofmap
