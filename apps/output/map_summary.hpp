// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/pipeline/room_map.hpp>

namespace tofmap::app {

/// Prints what a map consists of, which frames are in no map, and where the files are. `folder` is
/// the result.
void print_summary(const RoomMap& map, const std::filesystem::path& folder);

}  // namespace tofmap::app
