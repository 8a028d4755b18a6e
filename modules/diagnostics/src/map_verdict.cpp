// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/map_verdict.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>

namespace tofmap {
namespace {

/// The count with a noun, in the plural unless it is 1.
std::string number_of(int count, const char* noun) {
  return counted(static_cast<std::size_t>(count), noun);
}

/// Adds reasons and the verdicts that they lead to.
class Judge {
 public:
  explicit Judge(const MapEvidence& evidence) : evidence_(evidence) {}

  void judge_coverage();
  void judge_accuracy();
  void judge_certainty();
  void judge_places();
  Judgement judgement() && { return std::move(judgement_); }
  void hold_against(Verdict verdict, std::string reason);

 private:
  const MapEvidence& evidence_;
  Judgement judgement_;
};

void Judge::hold_against(Verdict verdict, std::string reason) {
  judgement_.verdict = std::max(judgement_.verdict, verdict);
  judgement_.reasons.push_back(std::move(reason));
}

/// Whether frames are missing from the map.
void Judge::judge_coverage() {
  constexpr double half_percent = 50;  // with fewer frames, most of the recording is missing
  const bool has_half = percent_of_frames(evidence_, evidence_.registered) >= half_percent;
  const Verdict if_incomplete = has_half ? Verdict::check : Verdict::bad;
  const double registered_percent =
      percent_of_frames(evidence_, evidence_.registered + evidence_.separate);
  if (registered_percent < nearly_all_percent) {
    hold_against(if_incomplete, fmt::format("{:.0f} % of the frames are in no map ({})",
                                            100 - registered_percent, told(evidence_.missing)));
  }
  if (evidence_.separate_maps > 0) {
    hold_against(
        if_incomplete,
        fmt::format("tracking was lost, and {} with {}{} could not be joined with this one",
                    number_of(evidence_.separate_maps, "other map"),
                    number_of(evidence_.separate, "frame"),
                    evidence_.separate_maps > 1 ? " in total" : ""));
  }
}

/// Whether the surface is where the ground truth has it.
void Judge::judge_accuracy() {
  if (!evidence_.accuracy_m) return;
  const Verdict verdict = verdict_on_accuracy(*evidence_.accuracy_m, evidence_.voxel_m);
  if (verdict != Verdict::good) {
    hold_against(verdict, "the error of its surface is larger than a voxel");
  }
}

/// Whether the surfaces constrained the path.
void Judge::judge_certainty() {
  if (evidence_.position_sigma_m > most_position_sigma_m) {
    hold_against(Verdict::check,
                 fmt::format("the position at frame {} is uncertain by {:.2f} m (one standard "
                             "deviation): the surfaces seen on the way there, or a gap in the "
                             "recording, did not determine all directions of motion",
                             evidence_.least_certain_frame, evidence_.position_sigma_m));
  }
  const double slow_percent = percent_of_frames(evidence_, evidence_.registered_slowly);
  if (slow_percent > most_slow_percent) {
    hold_against(Verdict::check,
                 fmt::format("{:.0f} % of the frames took many iterations to register: their "
                             "surfaces, or noise, hardly determined some directions of motion",
                             slow_percent));
  }
}

/// Whether places were recognised that are others, or may be.
void Judge::judge_places() {
  if (evidence_.blind_joins > 0) {
    hold_against(
        Verdict::check,
        fmt::format("after more than two seconds without tracking, the camera was found again only "
                    "by the look of the place ({}), and another place may look the same",
                    number_of(evidence_.blind_joins, "time")));
  }
  if (evidence_.contradicted_loops > 0) {
    hold_against(Verdict::check, "the map contradicts " +
                                     number_of(evidence_.contradicted_loops, "recognised place"));
  }
  if (evidence_.joins > 0) {
    judgement_.remarks.push_back(
        fmt::format("maps that began when tracking was lost were joined at recognised places ({})",
                    number_of(evidence_.joins, "join")));
  }
  if (evidence_.joins_taken_back > 0) {
    judgement_.remarks.push_back(
        fmt::format("{} looked like one seen before but proved to be another; the maps were "
                    "separated again",
                    number_of(evidence_.joins_taken_back, "place")));
  }
}

}  // namespace

Judgement judge(const MapEvidence& evidence) {
  Judge judge(evidence);
  if (evidence.is_empty) judge.hold_against(Verdict::bad, "the map is empty");
  if (!evidence.is_unwrapped) judge.hold_against(Verdict::bad, "nothing was unwrapped");
  judge.judge_coverage();
  judge.judge_accuracy();
  judge.judge_certainty();
  judge.judge_places();
  if (!evidence.is_seen_twice) {
    judge.hold_against(Verdict::check, "no place was seen by two frames");
  }
  if (evidence.is_interrupted) judge.hold_against(Verdict::check, "the run was interrupted");
  if (evidence.warnings > 0) {
    judge.hold_against(Verdict::check, number_of(evidence.warnings, "warning"));
  }
  return std::move(judge).judgement();
}

Verdict verdict_on_extension(MapEvidence evidence) {
  evidence.registered_slowly = 0;
  constexpr double most_overlooked_sigma_m = 0.2;
  const bool are_few = percent_of_frames(evidence, evidence.uncertain) <= 100 - nearly_all_percent;
  if (are_few && evidence.position_sigma_m <= most_overlooked_sigma_m) {
    evidence.position_sigma_m = 0;
  }
  return judge(evidence).verdict;
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
