// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {

/// The indices in the middle of `wanted` equal parts of 0 … total − 1, in ascending order. All
/// indices if `wanted` is larger than `total`.
std::vector<int> spread_indices(int total, int wanted);

/// A frame of a run, with what unwrapping and filters made of it.
struct SampledFrame {
  Frame recorded;
  Frame returns;           ///< PreparedFrame::returns, without amplitudes
  UnwrapResult unwrapped;  ///< without errors
  RangeImage filtered;
};

/// Keeps some frames of a run, spread evenly over it, for report pages, pictures and consistency
/// measures, so that no frame is unwrapped a second time for them. Frames that were saved are in
/// the file of the map, not in memory, until bring_back().
class FrameSample {
 public:
  /// `total` is the number of frames of the run. If it is known, the sample keeps the frames at
  /// spread_indices(*total, wanted). If it is empty (unknown), the sample keeps every n-th frame,
  /// where n grows with the run: at least `wanted` frames if the run is that long, and fewer than
  /// twice as many. Fewer large images are kept, so that the sample fits into 128 MB, but at least
  /// one.
  FrameSample(const CameraModel& camera, int wanted, std::optional<int> total);

  /// Whether add() would keep the frame of this index. False if the length of the run is unknown.
  bool wants(int index) const;

  /// Keeps the frame if it belongs to the sample, and ignores it otherwise. Frames must be added in
  /// ascending order of their indices.
  void add(const Frame& recorded, const PreparedFrame& prepared);

  /// Invalidates the filtered ranges of what moves in a frame that was added (reason
  /// `free_space_violation`). `still` is its cloud without the surface of what moves
  /// (Motion::still). Ignored if the frame is not kept. Throws InputError if the frame is in the
  /// file alone and cannot be read.
  void drop_moving(int index, const SurfaceCloud& still);

  /// Keeps `count` of the frames, spread evenly, and frees the memory of the others.
  void thin_out(int count);

  /// Stores the frames kept so far, but for those that note_saved() tells are stored already. The
  /// length of the run must be known.
  void save(MapStore::Commit& commit) const;
  /// Must be called after the commit to this store was finished, before another frame is added.
  /// From then on, the frames are in the file alone.
  void note_saved(const MapStore& store);

  /// Reads all frames that are in the file alone into memory. If some cannot be read any more, they
  /// are left out of the sample; then throws InputError, once the others are there.
  void bring_back();

  /// Replaces the frames by saved ones. The sample of a resumed run, whose first `frames_done`
  /// frames are processed, is then the same as without the interruption. If it was constructed with
  /// other arguments, it has at most as many of the saved frames as it wants of these. The length
  /// of the run must be known. Throws InputError if they are damaged.
  void load(const MapStore& store, int frames_done);

  /// The frames kept so far, in ascending order of their indices. Throws UsageError if some are in
  /// the file alone: after note_saved(), bring_back() must be called first.
  const std::vector<SampledFrame>& frames() const;

 private:
  bool is_its_turn(int index);
  void read(SampledFrame& frame) const;
  void drop_every_second();

  std::vector<int> wanted_indices_;  ///< empty if the length is unknown
  bool has_known_length_;
  std::size_t most_;                  ///< number of frames at which every second one is dropped
  std::size_t step_ = 1;              ///< keeps every step_-th frame if the length is unknown
  std::size_t passed_ = 0;            ///< frames offered to add() so far if the length is unknown
  std::vector<SampledFrame> frames_;  ///< those in the file alone have no phases
  std::set<int> unsaved_;  ///< indices of frames that were added or changed since note_saved()
  std::function<std::string(const std::string& name)>
      read_entry_;  ///< of the file: MapStore::reader()
  CameraModel camera_;
};

/// The consistency measures of a map, computed from at most consistency_frames() of the sampled
/// frames. `map` must be finished: the poses come from its trajectory, and a frame without a pose
/// counts as not registered. Throws UsageError as FrameSample::frames() does.
Consistency consistency_of(const RoomMap& map, const FrameSample& sample, const SensorModel& sensor,
                           UnwrapMethod method);

}  // namespace tofmap
