// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/pipeline/room_map.hpp>

namespace tofmap::app {

// Which frames of a recording are in which of its maps, in words. The run of the map must be
// finished, so that FrameRecord::map is set.

/// Frames that are in no map for the same reason.
struct AbsentFrames {
  std::string why;           ///< after "frames", for instance "without any range"
  std::string remedy;        ///< what to do about it
  std::vector<int> indices;  ///< in order
};

/// The frames that are in no map, by reason. Reasons without frames are left out.
std::vector<AbsentFrames> absent_frames(const RoomMap& map);

/// Indices as stretches, for instance "3, 7 to 9 and 12". After ten stretches, only the number of
/// the other frames.
std::string told_indices(const std::vector<int>& indices);

/// Names of the files of a separate map, in the folder of the result.
struct SeparateMapFiles {
  std::string map;
  std::string trajectory;
  std::string keyframes;
};

/// The names for RoomMap::separate_maps[index]. The first one is map 2.
SeparateMapFiles files_of_separate_map(std::size_t index);

/// Which frames RoomMap::separate_maps[index] has, and when they were recorded: "frames 30 to 49,
/// 2.00 to 3.27 s after the first frame".
std::string told_extent(const RoomMap& map, std::size_t index);

/// When and why RoomMap::separate_maps[index] began, to follow "it began": "after a gap of 1.70 s".
std::string told_beginning(const RoomMap& map, std::size_t index);

/// The separate maps for a report: files, counts, and extent in frames and time.
nlohmann::ordered_json separate_maps_json(const RoomMap& map);

/// The numbers of missing_frames().
nlohmann::ordered_json missing_json(const RoomMap& map);

}  // namespace tofmap::app
