// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/coverage.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct Reason {
  Absence absence;
  const char* why;
  const char* remedy;
};

constexpr std::array<Reason, 5> reasons{{
    {Absence::damaged, "damaged",
     "restore the files that are named below, or remove their lines from frames.txt"},
    {Absence::repeated, "repeating the frame before",
     "record again if they are many; the camera or its software stalled"},
    {Absence::no_return, "without any return",
     "do not cover the camera; look at its exposure if it was not covered"},
    {Absence::no_surface, "with too little surface",
     "keep more of the room in view, within the range of the camera"},
    {Absence::unregistered, "not registered",
     "move more slowly; keep what was mapped before in view"},
}};

/// The records of the frames of a separate map, from the first to the last, with those in between.
struct Extent {
  std::vector<FrameRecord>::const_iterator first;
  std::vector<FrameRecord>::const_iterator last;
};

Extent extent_of(const RoomMap& map, std::size_t index) {
  const auto number = static_cast<int>(index) + 2;
  const auto first = std::ranges::find(map.frames, number, &FrameRecord::map);
  const auto last =
      std::ranges::find(map.frames.rbegin(), map.frames.rend(), number, &FrameRecord::map);
  return {first, std::prev(last.base())};
}

}  // namespace

std::vector<AbsentFrames> absent_frames(const RoomMap& map) {
  std::vector<AbsentFrames> absent;
  for (const Reason& reason : reasons) {
    AbsentFrames frames{reason.why, reason.remedy, {}};
    for (const FrameRecord& record : map.frames) {
      if (absence_of(record) == reason.absence) frames.indices.push_back(record.index);
    }
    if (!frames.indices.empty()) absent.push_back(std::move(frames));
  }
  return absent;
}

std::string told_indices(const std::vector<int>& indices) {
  constexpr std::size_t most_stretches = 10;
  std::vector<std::string> stretches;
  for (std::size_t i = 0; i < indices.size();) {
    if (stretches.size() == most_stretches) {
      stretches.push_back(std::to_string(indices.size() - i) + " more");
      break;
    }
    std::size_t end = i + 1;
    while (end < indices.size() && indices[end] == indices[end - 1] + 1) ++end;
    stretches.push_back(end - i == 1 ? std::to_string(indices[i])
                                     : fmt::format("{} to {}", indices[i], indices[end - 1]));
    i = end;
  }
  if (stretches.size() < 2) return joined(stretches, "");
  const std::string last = stretches.back();
  stretches.pop_back();
  return joined(stretches, ", ") + " and " + last;
}

SeparateMapFiles files_of_separate_map(std::size_t index) {
  constexpr std::size_t first = 2;
  const std::string number = "_" + std::to_string(first + index);
  return {"map" + number + ".ply", "trajectory" + number + ".txt", "keyframes" + number + ".txt"};
}

std::string told_extent(const RoomMap& map, std::size_t index) {
  const auto [first, last] = extent_of(map, index);
  const double start_s = map.frames.front().timestamp_s;
  return fmt::format("frames {} to {}, {:.2f} to {:.2f} s after the first", first->index,
                     last->index, first->timestamp_s - start_s, last->timestamp_s - start_s);
}

std::string told_beginning(const RoomMap& map, std::size_t index) {
  const auto first = extent_of(map, index).first;
  const auto before = std::find_if(std::make_reverse_iterator(first), map.frames.rend(),
                                   [](const FrameRecord& record) { return record.map > 0; });
  if (before == map.frames.rend()) return "with the recording";
  const auto between = std::distance(before.base(), first);
  const double gap_s = first->timestamp_s - before->timestamp_s;
  if (between == 0) {
    constexpr double long_gap_s = 0.5;  // cameras take several frames a second
    return gap_s > long_gap_s
               ? fmt::format("after a gap of {:.2f} s", gap_s)
               : fmt::format("because frame {} does not fit the frames before it", first->index);
  }
  return fmt::format("after {} that {} in no map",
                     counted(static_cast<std::size_t>(between), "frame"),
                     between == 1 ? "is" : "are");
}

Json separate_maps_json(const RoomMap& map) {
  Json separate = Json::array();
  for (std::size_t i = 0; i < map.separate_maps.size(); ++i) {
    const SeparateMap& one = map.separate_maps[i];
    const auto [first, last] = extent_of(map, i);
    separate.push_back({{"map", files_of_separate_map(i).map},
                        {"registered", one.trajectory.size()},
                        {"keyframes", one.keyframes.size()},
                        {"map_points", one.surface.size()},
                        {"first_frame", first->index},
                        {"last_frame", last->index},
                        {"first_timestamp", first->timestamp_s},
                        {"last_timestamp", last->timestamp_s}});
  }
  return separate;
}

Json missing_json(const RoomMap& map) {
  const MissingFrames missing = missing_frames(map);
  return {{"damaged", missing.damaged},
          {"repeated", missing.repeated},
          {"without_return", missing.without_return},
          {"without_surface", missing.without_surface},
          {"unregistered", missing.unregistered}};
}

}  // namespace tofmap::app
