// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <cstdint>
#include <vector>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// A number for each frame that is another one for other constraints.
std::vector<std::uint32_t> constraint_checksums(const std::vector<RegisteredFrame>& frames);

/// Replaces those rows of the table `registrations` whose frames have other checksums than before.
void write_registrations(const std::vector<RegisteredFrame>& frames,
                         const std::vector<std::uint32_t>& before,
                         const std::vector<std::uint32_t>& after, SQLite::Database& database);

/// Reads a row of the table `registrations`, and adds it to its frame. Throws InputError if it is
/// damaged. `keyframes` is the number of keyframes of the map.
void read_registration(SQLite::Statement& row, int keyframes, std::vector<RegisteredFrame>& frames);

}  // namespace tofmap
