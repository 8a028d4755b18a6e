// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap {
struct RoomMap;
}

namespace tofmap::app {

// What a report says at its head. docs/reports.md states the same rules.

/// Of a map whose truth is known: good within the size of its voxels, bad beyond five times that,
/// or if it is empty.
Verdict verdict_on(const MapScore& score, double voxel_m);

/// Of a map made by `method`: the worst of what is known of it. `score` is of its surface, if that
/// is known; `is_warned` tells whether recording or map are doubted for anything else.
Verdict verdict_on(const RoomMap& map, const std::string& method,
                   const std::optional<MapScore>& score, double voxel_m, bool is_warned);

/// Of ranges alone; NaN: not known.
Verdict verdict_on_wraps(double wrong_wrap_percent);

/// Frames that were placed, and those of them with a direction that no surface held, of all frames
/// that came, in percent; 0 if none came.
double placed_percent(const RoomMap& map);
double degenerate_percent(const RoomMap& map);

}  // namespace tofmap::app
