// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <cstdint>
#include <span>
#include <vector>

#include <tofmap/mapping/map_change.hpp>

namespace tofmap {

/// A number that is another one for other changes.
std::uint32_t checksum_of(std::span<const MapChange> changes);

/// Replaces the rows of the table `changes`.
void write_changes(std::span<const MapChange> changes, SQLite::Database& database);

/// Reads a row of the table `changes`. Throws InputError if it is damaged. `recordings` is the
/// number of recordings of the map.
MapChange change_in(SQLite::Statement& row, int recordings);

}  // namespace tofmap
