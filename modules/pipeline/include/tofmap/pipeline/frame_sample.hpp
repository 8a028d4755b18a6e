// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// The indices in the middle of `wanted` equal parts of 0 … total − 1, in ascending order. All
/// indices if `wanted` is larger than `total`.
std::vector<int> spread_indices(int total, int wanted);

/// A frame of a run, with what unwrapping and filters made of it.
struct SampledFrame {
  DualFrequencyFrame recorded;
  DualFrequencyFrame returns;  ///< PreparedFrame::returns, without amplitudes
  UnwrapResult unwrapped;
  RangeImage filtered;
};

/// Keeps some frames of a run in memory, spread evenly over it, for pages, pictures and consistency
/// measures: so no frame is read or unwrapped a second time for them.
class FrameSample {
 public:
  /// Keeps the frames at spread_indices(*total, wanted). If the length of the run is unknown, keeps
  /// every n-th frame, where n grows with the run: at least `wanted` frames if as many come, and
  /// fewer than twice as many. Of large images it keeps fewer, so that 384 MB hold them, but at
  /// least one.
  FrameSample(const CameraModel& camera, int wanted, std::optional<int> total);

  /// Whether add() would keep the frame of this index. Only if the length of the run is known.
  bool wants(int index) const;

  /// Keeps the frame if its turn has come. Frames come in any order if the length is known, else in
  /// ascending order.
  void add(const DualFrequencyFrame& recorded, const PreparedFrame& prepared);

  /// Of the frames before `end` that are to be kept, the indices of those that were not added.
  /// Empty if the length of the run is unknown.
  std::vector<int> missing(int end) const;

  /// Keeps `count` of the frames, spread evenly, and frees the memory of the others.
  void thin_out(int count);

  /// In ascending order of their indices.
  const std::vector<SampledFrame>& frames() const { return frames_; }

 private:
  bool is_its_turn(int index);
  void drop_every_second();

  std::vector<int> wanted_indices_;  ///< if the length is known
  bool has_known_length_;
  std::size_t most_;      ///< frames, before every second one is dropped
  std::size_t step_ = 1;  ///< every so many frames one is kept
  std::size_t passed_ = 0;
  std::vector<SampledFrame> frames_;
};

/// The measures of consistency of a map, from at most consistency_frames() of the sampled frames.
/// `map` is finished: poses are taken from its trajectory.
Consistency consistency_of(const RoomMap& map, const FrameSample& sample, const SensorModel& sensor,
                           UnwrapMethod method);

}  // namespace tofmap
