// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/coverage.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/core/median.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

const char* remedy_for(Absence absence) {
  switch (absence) {
    case Absence::damaged:
      return "restore the files that are named below, or remove their lines from frames.txt";
    case Absence::repeated:
      return "the camera or its software stalled: record again";
    case Absence::without_range:
      return "do not cover the camera; if it was not covered, look at its exposure";
    case Absence::without_surface:
      return "keep more of the room in view, within the range of the camera";
    case Absence::unregistered:
      return "move more slowly; keep what was mapped before in view";
  }
  return "";
}

/// The median time between consecutive frames. 0 if there are fewer than two.
double median_period_s(const RoomMap& map) {
  std::vector<double> periods_s;
  for (std::size_t i = 1; i < map.frames.size(); ++i) {
    periods_s.push_back(map.frames[i].timestamp_s - map.frames[i - 1].timestamp_s);
  }
  return periods_s.empty() ? 0 : median(periods_s);
}

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
  std::map<Absence, std::vector<int>> indices;
  for (const FrameRecord& record : map.frames) {
    if (const auto absence = absence_of(record)) indices[*absence].push_back(record.index);
  }
  std::vector<AbsentFrames> absent;
  for (auto& [absence, frames] : indices) {
    absent.push_back({std::string(told(absence)), remedy_for(absence), std::move(frames)});
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
  return fmt::format("frames {} to {}, {:.2f} to {:.2f} s after the first frame", first->index,
                     last->index, first->timestamp_s - start_s, last->timestamp_s - start_s);
}

std::string told_beginning(const RoomMap& map, std::size_t index) {
  const auto first = extent_of(map, index).first;
  const auto before = std::find_if(std::make_reverse_iterator(first), map.frames.rend(),
                                   [](const FrameRecord& record) { return record.map > 0; });
  if (before == map.frames.rend()) return "with the recording";
  const auto missed = static_cast<std::size_t>(std::distance(before.base(), first));
  constexpr double most_periods = 3.5;  // as odometry counts a gap
  const double gap_s = first->timestamp_s - before->timestamp_s;
  const bool has_gap = gap_s > (most_periods + static_cast<double>(missed)) * median_period_s(map);
  std::string told;
  if (missed > 0) {
    told = "after " + counted(missed, "frame") + (missed == 1 ? " that is" : " that are") +
           " in no map";
  }
  if (has_gap) told += fmt::format("{}a gap of {:.2f} s", missed > 0 ? " and " : "after ", gap_s);
  if (told.empty()) {
    told = fmt::format("because frame {} does not fit the frames before it", first->index);
  }
  return told;
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
  MissingFrames missing = missing_frames(map);
  Json json;
  for (const NamedValue<Absence>& absence : named_values(Absence{})) {
    json[std::string(absence.name)] = missing[absence.value];
  }
  return json;
}

}  // namespace tofmap::app
