// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "database.hpp"

#include <cstdint>
#include <vector>

#include <tofmap/mapping/map_content.hpp>

namespace tofmap {

/// What the row of a keyframe holds, as far as it may change.
struct WrittenKeyframe {
  Pose world_from_camera;
  int recording = 0;
  int frame_index = 0;
  int map = 0;
  int taken_in = 0;
  int submap = 0;
  std::uint64_t cloud = 0;  ///< KeyframeCloud::number()
};

/// What the tables of a file hold of a map, as far as is needed to find out what has changed since.
struct WrittenContent {
  std::vector<WrittenKeyframe> keyframes;
  std::vector<std::vector<KeyframeLink>> links;
  std::vector<int> submap_anchors;
  std::vector<std::uint64_t> submap_revisions;
  std::vector<std::uint32_t> frames;       ///< a checksum of each
  std::vector<std::uint32_t> constraints;  ///< of each frame, a checksum of those that it has
  std::uint32_t changes = 0;               ///< checksum_of() them; 0 without changes
};

/// The same of a map that was just read from the file or written to it.
WrittenContent written(const MapContent& content);

/// What need not stay in memory once the tables are committed.
struct StoredParts {
  std::vector<int> clouds;   ///< ids of the keyframes whose clouds were written
  std::vector<int> submaps;  ///< indices of the submaps, but for the latest, which changes next
};

/// Brings the tables up to date with a map, given what they hold, and what they are to hold, which
/// is written() of the map. Must be called in a transaction.
StoredParts write_content(const MapContent& content, const WrittenContent& before,
                          const WrittenContent& after, SQLite::Database& database);

}  // namespace tofmap
