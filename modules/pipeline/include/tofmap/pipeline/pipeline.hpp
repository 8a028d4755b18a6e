// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {

/// The options of all stages, from phases to map.
struct PipelineOptions {
  UnwrapOptions unwrap;
  FilterOptions filters;
  CloudOptions cloud;
  RegistrationOptions registration;
  OdometryOptions odometry;
  LoopOptions loops;
  SurfaceMapOptions map;
};

/// Adds every stage's options to a table, under the stage's name.
void bind_options(OptionTable& table, PipelineOptions& options);

/// Wall-clock time of each stage, milliseconds.
struct StageTimes {
  double unwrap_ms = 0;
  double filter_ms = 0;
  double cloud_ms = 0;
  double register_ms = 0;
  double map_ms = 0;
  double loop_ms = 0;

  double total_ms() const {
    return unwrap_ms + filter_ms + cloud_ms + register_ms + map_ms + loop_ms;
  }
};

/// A frame as far as it can be processed without the frames before it.
struct PreparedFrame {
  int index = 0;
  double timestamp_s = 0;
  DualFrequencyFrame returns;  ///< what was unwrapped: MeasuredFrame::returns
  UnwrapResult unwrapped;
  FilterResult filtered;
  std::shared_ptr<const SurfaceCloud> cloud;
  StageTimes times;
};

/// A frame and its errors, as one FrameMeasurer measures all frames in their order.
struct TimedMeasurement {
  MeasuredFrame frame;
  double milliseconds = 0;
};
TimedMeasurement measure_frame(const DualFrequencyFrame& frame, FrameMeasurer& measurer);

/// Phases to surface. Depends on no other frame, so frames that were measured can be prepared side
/// by side, each thread with an unwrapper of its own.
PreparedFrame prepare_frame(TimedMeasurement measured, Unwrapper& unwrapper,
                            const SensorModel& sensor, const PixelRays& rays,
                            const PipelineOptions& options);

/// The same as far as ranges go: `cloud` is null.
PreparedFrame prepare_ranges(TimedMeasurement measured, Unwrapper& unwrapper,
                             const SensorModel& sensor, const PixelRays& rays,
                             const PipelineOptions& options);

/// What became of one frame.
struct FrameRecord {
  int index = 0;
  double timestamp_s = 0;
  std::string damage;    ///< not empty: the frame could not be read, and nothing else holds
  bool repeats = false;  ///< it has the phases of the frame before it, and only `index` and
                         ///< `timestamp_s` hold: it was not unwrapped
  int iterations = 0;
  int curl_violations = 0;
  double phase_noise_cycles = 0;
  int valid_pixels = 0;  ///< after unwrapping
  int kept_pixels = 0;   ///< after filtering
  std::vector<FilterCount> filters;
  TrackingResult tracking;
  StageTimes times;

  /// Whether the frame was unwrapped, filtered and tracked: it is neither damaged nor repeated.
  bool is_prepared() const { return damage.empty() && !repeats; }
};

/// A room as the camera saw it. The world is the frame of the first registered camera.
struct RoomMap {
  Trajectory trajectory;  ///< every frame that was registered
  Trajectory keyframes;
  MapCloud surface;
  std::vector<Loop> loops;          ///< places recognised
  std::vector<FrameRecord> frames;  ///< all, in order
  ErrorSurvey errors;               ///< of the camera, by the frames since the run was taken up
  bool interrupted = false;

  int damaged() const;
  int repeated() const;
  int degenerate() const;  ///< frames with a direction of motion that no surface constrained
};

/// What the frames and the surface of a map tell about it; accuracy and consistency are unknown.
MapEvidence evidence_of(const RoomMap& map, const PipelineOptions& options);

/// Throws InputError that names the first damage if more than half of the frames are damaged.
void refuse_mostly_damaged(int damaged, int total, const std::string& first_damage);
void refuse_mostly_damaged(const RoomMap& map);

/// What a caller may hang into a run; any may be empty.
struct MapHooks {
  /// Asked before each batch of frames with the number done so far; false ends the run early.
  std::function<bool(int frames_done)> keep_going;
  /// Called in order with every frame that was unwrapped, before it is registered.
  std::function<void(const DualFrequencyFrame& recorded, const PreparedFrame&)> on_frame;
};

/// A map on its way, which can be put aside and taken up again.
class MapRun {
 public:
  MapRun(const SensorModel& sensor, const PipelineOptions& options);

  /// Takes frames from the source until its end, or until a hook ends it. Frames that are damaged
  /// or cannot be registered are skipped, and said so in their record. Frames are prepared in
  /// parallel and registered in order; the result is the same for any number of threads.
  void advance(FrameSource& source, const MapHooks& hooks = {});

  /// Frames that were taken so far, in order.
  const std::vector<FrameRecord>& frames() const { return frames_; }
  bool is_interrupted() const { return is_interrupted_; }

  /// The errors of the camera, by the frames since the run was taken up.
  ErrorSurvey errors() const { return errors_.survey(); }

  /// The map so far.
  const RoomMapper& mapper() const { return mapper_; }

  /// All that is needed to go on; a run of the same sensor and options that loads it comes to the
  /// same result, to the bit. Only the build that wrote it can read it. Reading throws
  /// std::exception if it is damaged.
  void save(std::ostream& out) const;
  void load(std::istream& in);

  /// The map of the frames so far. The run is over with that.
  RoomMap finish();

 private:
  std::vector<SourcedFrame> take_next(FrameSource& source);
  std::vector<bool> find_repeats(const std::vector<SourcedFrame>& frames);

  SensorModel sensor_;
  PipelineOptions options_;
  PixelRays rays_;
  RoomMapper mapper_;
  FrameMeasurer measurer_;
  ErrorTally errors_;
  std::vector<SourcedFrame> ahead_;    ///< looked at ahead, and still to be mapped
  std::vector<Unwrapper> unwrappers_;  ///< one a thread
  std::vector<FrameRecord> frames_;
  DualFrequencyFrame last_;  ///< that could be read; empty before
  bool is_interrupted_ = false;
};

/// Frames in, a map out: the whole job.
RoomMap map_room(FrameSource& source, const PipelineOptions& options, const MapHooks& hooks = {});

}  // namespace tofmap
