// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/recorded_truth.hpp"
#include "runs/consistency.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/evaluation/range_score.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// What is known of the truth; any part may be missing.
struct Truth {
  Trajectory poses;
  ReferenceSurface surface;
};

/// Of a recording, as far as it can be read; tells its progress unless quiet. Throws Interrupted.
Truth read_truth(const SequenceReader& source, const RecordedTruth& recorded, bool quiet);

/// How right a map is, as far as the truth is known.
struct MapScores {
  std::optional<TrajectoryScore> trajectory;
  std::optional<MapScore> surface;
};
MapScores score_of(const RoomMap& map, const Truth& truth);

/// How one frame was unwrapped.
struct UnwrappingRecord {
  double timestamp_s = 0;
  std::optional<RangeScore> score;  ///< if the frame's true ranges are known
  ErrorsOverRange over_range;       ///< empty if they are not
  double milliseconds = 0;
  int iterations = 0;
  bool converged = false;
};

/// One method over a recording, and how right it is.
struct MethodResult {
  std::string name;
  std::vector<UnwrappingRecord> frames;  ///< those that could be read
  std::optional<RoomMap> map;            ///< if asked for
  MapScores scores;
  std::optional<Consistency> consistency;  ///< of a map that was not interrupted
  bool interrupted = false;
};

/// Throws UsageError if the truth has another size than the image.
UnwrappingRecord record_of(const UnwrapResult& unwrapped, double timestamp_s, double milliseconds,
                           const std::optional<ImageF>& truth_m, double wavelength_a_m);

/// The range errors of all frames.
ErrorsOverRange over_range(std::span<const UnwrappingRecord> frames);

/// From phases to the map. Throws InputError if more than half of the frames are damaged.
MethodResult run_down_to_map(const std::string& method, const SequenceReader& recording,
                             PipelineOptions options, const RecordedTruth& recorded,
                             const Truth& truth, bool quiet);

/// Unwrapping alone, frames side by side. Throws InputError as above.
MethodResult run_unwrapping(const std::string& method, const SequenceReader& recording,
                            UnwrapOptions options, const RecordedTruth& recorded, bool quiet);

}  // namespace tofmap::app
