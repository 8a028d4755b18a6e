// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scores.hpp"
#include "variants.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::accuracy {

/// Consecutive frames of one camera, for one Unwrapper: methods may learn from earlier frames.
struct Run {
  std::vector<DualFrequencyFrame> frames;
  std::vector<ImageF> truth_m;
};

/// What one row of a table is about. The sensor does not say how large the room is: no method is
/// told, as with a camera.
struct Case {
  std::string name;
  SensorModel sensor;
  std::vector<Run> runs;
};

/// How many runs of how many frames.
struct RunPlan {
  int runs = 6;
  int frames = 8;
};

/// The first frames of the runs, spread evenly over a recording of `total` frames; `shift` (0 to 1)
/// moves all of them, by that share of their distance. Runs are shortened if there are too few
/// frames.
std::vector<int> run_starts(int total, const RunPlan& plan, double shift = 0.5);

/// The cases whose scenes and seeds constants may be chosen on. `divisor` lessens the runs.
std::vector<Case> development_cases(int divisor);

/// The paper's experiments, and scenes with more counts than its two.
std::vector<Case> paper_cases(int divisor);

/// The cases of frozen.hpp.
std::vector<Case> frozen_cases(int divisor);

/// A recording with range_truth/, in runs. Frames that are damaged are left out.
Case recorded_case(const std::filesystem::path& folder, int divisor);

/// How the runs of the tables are made, for their captions.
std::string describe_runs(int divisor);

Score score_case(const Case& data, const Variant& variant);

/// The same for one run, unwrapped from its first frame on.
void score_run(const Run& run, const SensorModel& sensor, const Variant& variant, Score& score);

}  // namespace tofmap::accuracy
