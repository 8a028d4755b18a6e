// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/verdict.hpp"

#include <algorithm>

#include <tofmap/core/text.hpp>
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

Judgement judge(const MapEvidence& evidence) {
  constexpr double half_percent = 50;        // of the frames: else it is a map of something else
  constexpr double nearly_all_percent = 95;  // some are lost in any recording
  constexpr double some_percent = 10;        // of the frames may lean on the motion before them
  const RoomMap& map = evidence.map;
  Judgement judgement;
  const auto hold_against = [&](Verdict verdict, const std::string& reason) {
    judgement.verdict = std::max(judgement.verdict, verdict);
    judgement.reasons.push_back(reason);
  };
  if (map.surface.empty()) hold_against(Verdict::bad, "the map is empty");
  if (evidence.method == "none") hold_against(Verdict::bad, "nothing was unwrapped");
  const double placed = placed_percent(map);
  if (placed < nearly_all_percent) {
    hold_against(placed < half_percent ? Verdict::bad : Verdict::doubtful,
                 formatted("%.0f %% of the frames could not be placed", 100 - placed));
  }
  const Verdict of_surface =
      evidence.score ? verdict_on(*evidence.score, evidence.voxel_m) : Verdict::good;
  if (of_surface != Verdict::good) {
    hold_against(of_surface, "its error is larger than its voxels");
  }
  if (degenerate_percent(map) > some_percent) {
    hold_against(
        Verdict::doubtful,
        formatted("in %.0f %% of the frames no surface held a direction", degenerate_percent(map)));
  }
  if (!evidence.is_seen_twice) hold_against(Verdict::doubtful, "no place was seen by two frames");
  if (map.interrupted) hold_against(Verdict::doubtful, "the run was interrupted");
  if (evidence.is_warned) hold_against(Verdict::doubtful, "the warnings below");
  return judgement;
}

std::string told_reasons(const Judgement& judgement) {
  if (judgement.reasons.empty()) return "";
  return " Held against it: " + joined(judgement.reasons, "; ") + ".";
}

Verdict verdict_on_wraps(double wrong_wrap_percent) {
  // Maps bear a few percent, which filters drop, and are lost by a fifth (docs/experiments.md).
  constexpr double few_percent = 2;
  constexpr double many_percent = 10;
  if (wrong_wrap_percent > many_percent) return Verdict::bad;
  return wrong_wrap_percent <= few_percent ? Verdict::good : Verdict::doubtful;
}

}  // namespace tofmap::app
