// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/mapping/map_content.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// The file of the points that have changed, in the folder of a result.
inline constexpr const char* changes_file_name = "changes.ply";

/// The changes of a map for a report: kind, the recording that shows it and its date, number of
/// points, box, and how far it has moved.
nlohmann::ordered_json changes_json(const std::vector<MapChange>& changes,
                                    const std::vector<MapRecording>& recordings);

/// Prints the changes, one line each: "gone since 2026-11-29T08:30:00Z: 340 points around (1.20,
/// 0.35, 4.10)". Those beyond the first twenty are only counted.
void print_changes(const std::vector<MapChange>& changes,
                   const std::vector<MapRecording>& recordings);

/// The changes as a table of a page.
PageTable change_table(const std::vector<MapChange>& changes,
                       const std::vector<MapRecording>& recordings);

/// Writes the points of all changes as a PLY file: position, normal, colour (red: gone, green: new,
/// blue: moved), `kind` (0: gone, 1: new, 2: where it was before it moved, 3: where it has moved
/// to), `change` (index in changes_json()) and `recording` (index of the one that shows it).
void write_changes(const std::filesystem::path& file, const std::vector<MapChange>& changes);

}  // namespace tofmap::app
