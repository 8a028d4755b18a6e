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

/// Consecutive frames of one camera, to be unwrapped by one Unwrapper, since methods may use
/// earlier frames.
struct Run {
  std::vector<Frame> frames;
  std::vector<ImageF> truth_m;  ///< true radial ranges of each frame
};

/// The data of one row of a table. The sensor does not state the largest range of the scene, so
/// that methods do not know it, as with a real camera.
struct Case {
  std::string name;
  SensorModel sensor;
  std::vector<Run> runs;
};

/// The number of runs, and of frames in each.
struct RunPlan {
  int runs = 6;
  int frames = 8;
};

/// The index of the first frame of each run, spread evenly over a recording of `total` frames.
/// `shift` (0 to 1) moves all of them by this fraction of their distance.
std::vector<int> run_starts(int total, const RunPlan& plan, double shift = 0.5);

/// The cases that constants may be chosen on. `divisor` divides the number of runs.
std::vector<Case> development_cases(int divisor);

/// Scenes of the paper's experiments, and scenes that need more than the paper's two wrap counts.
/// Development data.
std::vector<Case> paper_cases(int divisor);

/// The cases with frozen data, see frozen.hpp.
std::vector<Case> frozen_cases(int divisor);

/// Runs of a recording with range_truth/. Damaged frames are left out.
Case recorded_case(const std::filesystem::path& folder, int divisor);

/// A sentence about the number of runs and frames, for the captions of tables.
std::string describe_runs(int divisor);

/// Unwraps all runs of a case and scores their frames.
Score score_case(const Case& data, const Variant& variant);

/// Unwraps one run and adds its frames to `score`.
void score_run(const Run& run, const SensorModel& sensor, const Variant& variant, Score& score);

}  // namespace tofmap::accuracy
