// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/evaluation/range_score.hpp>
#include <tofmap/evaluation/recorded_truth.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// The ground truth that maps are compared with. Either part may be empty.
struct Truth {
  Trajectory poses;
  ReferenceSurface surface;
};

/// Reads the truth of a recording as far as it can be read: all poses, and the surface that every
/// third frame saw. `on_frame` is called with the index of each frame that is read; what it throws
/// is passed on.
Truth read_truth(const SequenceReader& source, const RecordedTruth& recorded,
                 const std::function<void(int index)>& on_frame = {});

/// The scores of a map. Each is empty if its truth is unknown.
struct MapScores {
  std::optional<TrajectoryScore> trajectory;
  std::optional<MapScore> surface;
};
/// Scores the trajectory of a map and, after aligning it with the truth, its surface.
MapScores score_of(const RoomMap& map, const Truth& truth);

/// How one frame was unwrapped.
struct UnwrappingRecord {
  double timestamp_s = 0;
  std::optional<RangeScore> score;  ///< empty if the true ranges of the frame are unknown
  ErrorsOverRange over_range;       ///< empty if the true ranges of the frame are unknown
  double milliseconds = 0;          ///< time of measuring and unwrapping
  int iterations = 0;               ///< UnwrapResult::iterations
  std::optional<bool> converged;    ///< UnwrapResult::converged
};

/// Makes the record of a frame that took `milliseconds`. `truth_m` holds true radial ranges. Throws
/// UsageError if truth and image differ in size.
UnwrappingRecord record_of(const UnwrapResult& unwrapped, double timestamp_s, double milliseconds,
                           const std::optional<ImageF>& truth_m, double wavelength_a_m);

/// The range errors of all frames together.
ErrorsOverRange over_range(std::span<const UnwrappingRecord> frames);

/// The result of an unwrapping method on a recording.
struct MethodResult {
  UnwrapMethod method = UnwrapMethod::joint;
  std::string name;  ///< name of `method`
  std::vector<UnwrappingRecord>
      frames;  ///< undamaged frames; run_down_to_map() leaves out repeated ones, too
  std::vector<SampledFrame> sample;        ///< some of the frames, spread evenly
  std::optional<RoomMap> map;              ///< empty if only unwrapping was asked for
  MapScores scores;                        ///< scores of the map
  std::optional<Consistency> consistency;  ///< empty without a map or if the run was interrupted
  bool interrupted = false;
};

/// How a method is run.
struct MethodRun {
  UnwrapMethod method = UnwrapMethod::joint;
  PipelineOptions options;  ///< `options.unwrap.method` is replaced by `method`
  int sample_frames = 0;    ///< wanted size of MethodResult::sample
  /// Called before each batch of frames with the number of frames done. False ends the run. May be
  /// empty.
  std::function<bool(int frames_done)> keep_going;
};

/// Runs a method from phases to the map. Throws InputError if more than half of the frames are
/// damaged.
MethodResult run_down_to_map(const MethodRun& run, const SequenceReader& recording,
                             const RecordedTruth& recorded, const Truth& truth);

/// Runs a method as far as unwrapping, frames in parallel; only the frames of the sample are
/// filtered. Throws InputError if more than half of the frames are damaged.
MethodResult run_unwrapping(const MethodRun& run, const SequenceReader& recording,
                            const RecordedTruth& recorded);

}  // namespace tofmap
