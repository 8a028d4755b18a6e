// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/map_verdict.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>

namespace tofmap {

Judgement judge(const MapEvidence& evidence) {
  constexpr double half_percent = 50;  // with fewer frames, most of the recording is missing
  // A wall that is off by 5 cm looks double: that must be two standard deviations away.
  constexpr double most_sigma_m = 0.025;
  Judgement judgement;
  const auto hold_against = [&](Verdict verdict, const std::string& reason) {
    judgement.verdict = std::max(judgement.verdict, verdict);
    judgement.reasons.push_back(reason);
  };
  if (evidence.is_empty) hold_against(Verdict::bad, "the map is empty");
  if (!evidence.is_unwrapped) hold_against(Verdict::bad, "nothing was unwrapped");
  const double registered_percent =
      percent_of_frames(evidence, evidence.registered + evidence.separate);
  if (registered_percent < nearly_all_percent) {
    hold_against(
        registered_percent < half_percent ? Verdict::bad : Verdict::check,
        fmt::format("{:.0f} % of the frames could not be registered", 100 - registered_percent));
  }
  if (evidence.separate_maps > 0) {
    hold_against(Verdict::check,
                 fmt::format("tracking was lost, and {} with {} could not be joined with this one",
                             counted(static_cast<std::size_t>(evidence.separate_maps), "other map"),
                             counted(static_cast<std::size_t>(evidence.separate), "frame")));
  }
  const Verdict of_surface = evidence.accuracy_m
                                 ? verdict_on_accuracy(*evidence.accuracy_m, evidence.voxel_m)
                                 : Verdict::good;
  if (of_surface != Verdict::good) {
    hold_against(of_surface, "the error of its surface is larger than a voxel");
  }
  if (evidence.position_sigma_m > most_sigma_m) {
    hold_against(Verdict::check,
                 fmt::format("the position at frame {} is uncertain by {:.2f} m (one standard "
                             "deviation), since surfaces seen on the way there did not constrain "
                             "all directions of motion",
                             evidence.least_certain_frame, evidence.position_sigma_m));
  }
  const double slow_percent = percent_of_frames(evidence, evidence.registered_slowly);
  if (slow_percent > most_slow_percent) {
    hold_against(Verdict::check,
                 fmt::format("{:.0f} % of the frames took many iterations to register, since their "
                             "surfaces, or noise, left some directions of motion open",
                             slow_percent));
  }
  if (evidence.blind_joins > 0) {
    hold_against(
        Verdict::check,
        fmt::format("{}, the camera was not tracked for more than two seconds and was found again "
                    "only by the look of the place, and another place may look the same",
                    counted(static_cast<std::size_t>(evidence.blind_joins), "time")));
  }
  if (evidence.unused_loops > 0) {
    hold_against(Verdict::check,
                 "the map contradicts " +
                     counted(static_cast<std::size_t>(evidence.unused_loops), "recognised place"));
  }
  if (evidence.joins > 0) {
    judgement.remarks.push_back(
        fmt::format("tracking was lost {}, and the camera was found again at recognised places",
                    counted(static_cast<std::size_t>(evidence.joins), "time")));
  }
  if (evidence.joins_taken_back > 0) {
    judgement.remarks.push_back(
        fmt::format("{}, a place looked like one seen before, but turned out to be another one",
                    counted(static_cast<std::size_t>(evidence.joins_taken_back), "time")));
  }
  if (!evidence.is_seen_twice) hold_against(Verdict::check, "no place was seen by two frames");
  if (evidence.is_interrupted) hold_against(Verdict::check, "the run was interrupted");
  if (evidence.is_warned) hold_against(Verdict::check, "there are warnings");
  return judgement;
}

std::string told_reasons(const Judgement& judgement) {
  std::string told;
  if (!judgement.reasons.empty()) told += " Reasons: " + joined(judgement.reasons, "; ") + ".";
  if (!judgement.remarks.empty()) told += " Also: " + joined(judgement.remarks, "; ") + ".";
  return told;
}

Verdict verdict_on_accuracy(double accuracy_m, double voxel_m) {
  constexpr double much = 5;
  if (!(accuracy_m <= much * voxel_m)) return Verdict::bad;  // NaN as well
  return accuracy_m <= voxel_m ? Verdict::good : Verdict::check;
}

Verdict verdict_on_wraps(double wrong_wrap_percent) {
  // Filters remove a few percent of wrong wraps; 20 % ruin a map (docs/experiments.md).
  constexpr double few_percent = 2;
  constexpr double many_percent = 10;
  if (wrong_wrap_percent > many_percent) return Verdict::bad;
  return wrong_wrap_percent <= few_percent ? Verdict::good : Verdict::check;
}

double percent_of_frames(const MapEvidence& evidence, int part) {
  return evidence.frames > 0 ? 100.0 * part / evidence.frames : 0;
}

}  // namespace tofmap
