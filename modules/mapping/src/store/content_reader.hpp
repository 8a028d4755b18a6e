// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <functional>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// How the parts of a map are read that are read when they are needed.
struct PartReaders {
  std::function<CompactCloud(int keyframe)> cloud;
  std::function<SurfaceMap(int submap, const SurfaceMapOptions& options)> surface;
};

/// Reads a map, but for the clouds of its keyframes and the surfaces of its submaps. Throws
/// InputError if what the tables hold is no map. Surfaces are checked, but clouds are not.
MapContent read_content(SQLite::Database& database, const PartReaders& readers);

}  // namespace tofmap
