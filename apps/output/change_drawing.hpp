// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/map_change.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap::app {

/// The colour of a change: red if gone, green if new, blue if moved.
Rgb color_of(ChangeKind kind);

/// What the colours of changes mean, as a phrase.
inline constexpr const char* change_colors_told =
    "red: no longer there, green: not there before, blue: moved";

/// Adds the points of a change to a drawing of the map.
void add_change(Drawing& drawing, const MapChange& change, const Pose& drawing_from_world);

}  // namespace tofmap::app
