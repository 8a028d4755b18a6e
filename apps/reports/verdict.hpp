// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap {
struct RoomMap;
}

namespace tofmap::app {

// What a report says at its head. docs/reports.md states the same rules.

/// Of a map whose truth is known: good within the size of its voxels, bad beyond five times that,
/// or if it is empty.
Verdict verdict_on(const MapScore& score, double voxel_m);

/// A verdict, and why it is no better.
struct Judgement {
  Verdict verdict = Verdict::good;
  std::vector<std::string> reasons;
};

/// What is known of a map when it is judged.
struct MapEvidence {
  const RoomMap& map;
  std::string method;             ///< of unwrapping
  std::optional<MapScore> score;  ///< of its surface, if the truth is known
  double voxel_m = 0;
  bool is_seen_twice = true;  ///< frames overlap, so that they could have contradicted each other
  bool is_warned = false;     ///< recording or map are doubted for anything else
};

/// The worst of all that is known.
Judgement judge(const MapEvidence& evidence);

/// " Held against it: …", to go on a sentence with; empty if there is nothing.
std::string told_reasons(const Judgement& judgement);

/// Of ranges alone; NaN: not known, and so to be looked at.
Verdict verdict_on_wraps(double wrong_wrap_percent);

/// Frames that were placed, and those of them with a direction that no surface held, of all frames
/// that came, in percent; 0 if none came.
double placed_percent(const RoomMap& map);
double degenerate_percent(const RoomMap& map);

}  // namespace tofmap::app
