// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace tofmap {

/// "tofm": marks an SQLite database as a map (PRAGMA application_id).
inline constexpr int map_application_id = 0x746f666d;

/// The newest version of the format that this program reads, and the one that it writes (PRAGMA
/// user_version).
inline constexpr int map_format_version = 2;

/// SQL statements that make the tables of a map (docs/map-format.md) in an empty database.
std::string map_schema();

/// SQL statements that add what a map of an earlier version lacks.
std::string map_schema_since(int version);

}  // namespace tofmap
