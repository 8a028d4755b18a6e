// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tofmap/core/verdict.hpp>

namespace tofmap {

/// What is known about a map when it is judged.
struct MapEvidence {
  int frames = 0;      ///< frames of the recording, damaged ones included
  int registered = 0;  ///< frames with a pose
  int degenerate = 0;  ///< frames with a direction of motion that no surface constrained
  bool is_empty = false;
  bool is_interrupted = false;
  bool is_unwrapped = true;          ///< false for method `none`
  std::optional<double> accuracy_m;  ///< median error of the surface, if the truth is known
  double voxel_m = 0;
  bool is_seen_twice = true;  ///< frames overlap, so that they could have contradicted each other
  bool is_warned = false;     ///< there are warnings about the recording or the map
};

/// A verdict and the reasons why it is no better.
struct Judgement {
  Verdict verdict = Verdict::good;
  std::vector<std::string> reasons;
};

/// The worst verdict that any part of the evidence gives. docs/reports.md states the same rules.
Judgement judge(const MapEvidence& evidence);

/// " Held against it: …", which continues a sentence. Empty if there are no reasons.
std::string told_reasons(const Judgement& judgement);

/// The verdict on a map whose truth is known: good up to the size of a voxel, bad beyond five times
/// that. NaN, the accuracy of an empty map, is bad.
Verdict verdict_on_accuracy(double accuracy_m, double voxel_m);

/// The verdict on ranges alone. NaN (not known) is doubtful.
Verdict verdict_on_wraps(double wrong_wrap_percent);

/// `part` of all frames that came, in percent. 0 if none came.
double percent_of_frames(const MapEvidence& evidence, int part);

}  // namespace tofmap
