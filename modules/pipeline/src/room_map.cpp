// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/room_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <tofmap/core/error.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

std::optional<Absence> absence_of(const FrameRecord& record) {
  if (record.map > 0) return std::nullopt;
  if (!record.damage.empty()) return Absence::damaged;
  if (record.repeats) return Absence::repeated;
  if (record.valid_pixels == 0) return Absence::without_range;
  return record.tracking.status == TrackingStatus::no_surface ? Absence::without_surface
                                                              : Absence::unregistered;
}

int RoomMap::repeated() const {
  return static_cast<int>(std::ranges::count_if(frames, &FrameRecord::repeats));
}

int RoomMap::damaged() const {
  return static_cast<int>(std::ranges::count_if(
      frames, [](const FrameRecord& record) { return !record.damage.empty(); }));
}

int RoomMap::degenerate() const {
  return static_cast<int>(std::ranges::count_if(frames, [](const FrameRecord& record) {
    return record.tracking.registration.degenerate_directions > 0;
  }));
}

int RoomMap::separate() const {
  return std::accumulate(separate_maps.begin(), separate_maps.end(), 0,
                         [](int sum, const SeparateMap& one) {
                           return sum + static_cast<int>(one.trajectory.size());
                         });
}

std::vector<int> RoomMap::frames_in(int number) const {
  std::vector<int> indices;
  for (const FrameRecord& record : frames) {
    if (record.map == number) indices.push_back(record.index);
  }
  return indices;
}

bool frames_agree(const RoomMap& map, const Consistency& consistency) {
  const auto frames = static_cast<double>(map.frames.size());
  return static_cast<double>(map.trajectory.size()) >= nearly_all_percent / 100 * frames &&
         map.registered_slowly <= most_slow_percent / 100 * frames && map.separate_maps.empty() &&
         !std::isnan(consistency.contradicted_percent) && warnings_about(consistency).empty();
}

MissingFrames missing_frames(const RoomMap& map) {
  MissingFrames missing;
  for (const FrameRecord& record : map.frames) {
    if (const auto absence = absence_of(record)) ++missing[*absence];
  }
  return missing;
}

MapEvidence evidence_of(const RoomMap& map, const PipelineOptions& options,
                        const Consistency& consistency, const std::vector<std::string>& warnings) {
  return {.frames = static_cast<int>(map.frames.size()),
          .registered = static_cast<int>(map.trajectory.size()),
          .missing = missing_frames(map),
          .separate = map.separate(),
          .separate_maps = static_cast<int>(map.separate_maps.size()),
          .joins = map.joins,
          .blind_joins = map.blind_joins,
          .joins_taken_back = map.joins_taken_back,
          .contradicted_loops = map.contradicted_loops,
          .position_sigma_m = map.least_certain.error.position_m,
          .least_certain_frame = map.least_certain.frame,
          .uncertain = map.uncertain,
          .registered_slowly = map.registered_slowly,
          .is_empty = map.surface.empty(),
          .is_interrupted = map.interrupted,
          .is_unwrapped = options.unwrap.method != UnwrapMethod::none,
          .accuracy_m = std::nullopt,
          .voxel_m = options.map.voxel_m,
          .is_seen_twice = !std::isnan(consistency.contradicted_percent),
          .warnings = static_cast<int>(warnings.size())};
}

void refuse_mostly_damaged(int damaged, int total, const std::string& first_damage) {
  if (2 * damaged <= total) return;
  throw InputError(
      std::to_string(damaged) + " of " + std::to_string(total) +
      " frames are damaged, which is more than half; nothing was written. The first damage: " +
      first_damage);
}

void refuse_mostly_damaged(const RoomMap& map) {
  const auto first = std::ranges::find_if(
      map.frames, [](const FrameRecord& record) { return !record.damage.empty(); });
  if (first == map.frames.end()) return;
  refuse_mostly_damaged(map.damaged(), static_cast<int>(map.frames.size()), first->damage);
}

}  // namespace tofmap
