// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "verdict.hpp"

#include <algorithm>

#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {
namespace {

double percent_of_frames(const RoomMap& map, std::size_t part) {
  if (map.frames.empty()) return 0;
  return 100 * static_cast<double>(part) / static_cast<double>(map.frames.size());
}

}  // namespace

double placed_percent(const RoomMap& map) { return percent_of_frames(map, map.trajectory.size()); }

double degenerate_percent(const RoomMap& map) {
  const auto is_degenerate = [](const FrameRecord& frame) {
    return frame.tracking.registration.degenerate_directions > 0;
  };
  return percent_of_frames(
      map, static_cast<std::size_t>(std::ranges::count_if(map.frames, is_degenerate)));
}

Verdict verdict_on(const MapScore& score, double voxel_m) {
  constexpr double much = 5;
  if (!(score.accuracy_m <= much * voxel_m)) return Verdict::bad;  // also of an empty map
  return score.accuracy_m <= voxel_m ? Verdict::good : Verdict::doubtful;
}

Verdict verdict_on(const RoomMap& map, const std::string& method,
                   const std::optional<MapScore>& score, double voxel_m, bool is_warned) {
  constexpr double half_percent = 50;        // of the frames: else it is a map of something else
  constexpr double nearly_all_percent = 95;  // some are lost in any recording
  constexpr double some_percent = 10;        // of the frames may lean on the motion before them
  const double placed = placed_percent(map);
  if (map.surface.empty() || placed < half_percent || method == "none") return Verdict::bad;
  const Verdict of_surface = score ? verdict_on(*score, voxel_m) : Verdict::good;
  const bool is_doubted = is_warned || map.interrupted || placed < nearly_all_percent ||
                          degenerate_percent(map) > some_percent;
  return std::max(of_surface, is_doubted ? Verdict::doubtful : Verdict::good);
}

Verdict verdict_on_wraps(double wrong_wrap_percent) {
  // Maps bear a few percent, which filters drop, and are lost by a fifth (docs/experiments.md).
  constexpr double few_percent = 2;
  constexpr double many_percent = 10;
  if (wrong_wrap_percent > many_percent) return Verdict::bad;
  return wrong_wrap_percent <= few_percent ? Verdict::good : Verdict::doubtful;
}

}  // namespace tofmap::app
