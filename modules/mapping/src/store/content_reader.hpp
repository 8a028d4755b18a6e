// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <functional>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// Reads a map, but for the clouds of its keyframes, which `read_cloud` reads by the id of the
/// keyframe when they are needed. Throws InputError if what the tables hold is no map.
MapContent read_content(SQLite::Database& database,
                        const std::function<CompactCloud(int keyframe)>& read_cloud);

}  // namespace tofmap
