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
#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {

/// The options of all stages, from phases to the map. In files and on the command line, each group
/// has the name of its field here, for instance `unwrap.method`.
struct PipelineOptions {
  UnwrapOptions unwrap;              ///< phases to ranges
  FilterOptions filters;             ///< which ranges are dropped or corrected
  CloudOptions cloud;                ///< ranges to points with normals
  RegistrationOptions registration;  ///< ICP of a frame against keyframes
  OdometryOptions odometry;          ///< camera tracking and choice of keyframes
  LoopOptions loops;                 ///< loop closure
  SurfaceMapOptions map;             ///< voxels of the map
};

/// Adds the options of every stage to a table, each group under the name of its field in
/// PipelineOptions.
void bind_options(OptionTable& table, PipelineOptions& options);

/// Wall-clock time that each stage took for one frame, milliseconds.
struct StageTimes {
  double unwrap_ms = 0;    ///< measuring noise and errors, and unwrapping
  double filter_ms = 0;    ///< filters
  double cloud_ms = 0;     ///< points and normals
  double register_ms = 0;  ///< registration with keyframes
  double map_ms = 0;       ///< integration into the map
  double loop_ms = 0;      ///< search for loops, and the pose graph

  double total_ms() const {
    return unwrap_ms + filter_ms + cloud_ms + register_ms + map_ms + loop_ms;
  }
};

/// A frame that has been unwrapped, filtered and turned into a cloud, but not registered yet.
struct PreparedFrame {
  int index = 0;
  double timestamp_s = 0;
  DualFrequencyFrame returns;  ///< the phases that were unwrapped: MeasuredFrame::returns
  UnwrapResult unwrapped;
  FilterResult filtered;
  std::shared_ptr<const SurfaceCloud> cloud;  ///< camera frame; null from prepare_ranges()
  StageTimes times;                           ///< of the stages up to the cloud; the others are 0
};

/// A measured frame and the time that measuring it took.
struct TimedMeasurement {
  MeasuredFrame frame;
  double milliseconds = 0;  ///< wall-clock time
};

/// Measures the next frame. One measurer must be given all frames of a recording in order. Throws
/// UsageError if the frame's images differ in size.
TimedMeasurement measure_frame(const DualFrequencyFrame& frame, FrameMeasurer& measurer);

/// Unwraps and filters a measured frame, and fits its surface. The result depends on no other
/// frame, so that measured frames can be prepared in parallel if each thread has its own unwrapper.
PreparedFrame prepare_frame(TimedMeasurement measured, Unwrapper& unwrapper,
                            const SensorModel& sensor, const PixelRays& rays,
                            const PipelineOptions& options);

/// Unwraps and filters a measured frame as prepare_frame() does, but makes no cloud: `cloud` is
/// null.
PreparedFrame prepare_ranges(TimedMeasurement measured, Unwrapper& unwrapper,
                             const SensorModel& sensor, const PixelRays& rays,
                             const PipelineOptions& options);

/// The result of processing one frame.
struct FrameRecord {
  int index = 0;
  double timestamp_s = 0;
  /// Why the frame could not be read; empty if it could. If it is not empty, only `damage`, `index`
  /// and `timestamp_s` have a meaning.
  std::string damage;
  /// The frame has the same phases as the frame before it, and was therefore not unwrapped. Then
  /// only `index`, `timestamp_s` and the status in `tracking` have a meaning.
  bool repeats = false;
  int iterations = 0;             ///< UnwrapResult::iterations
  int curl_violations = 0;        ///< UnwrapResult::curl_violations
  double phase_noise_cycles = 0;  ///< UnwrapResult::phase_noise_cycles
  int valid_pixels = 0;           ///< valid pixels after unwrapping
  int kept_pixels = 0;            ///< valid pixels after filtering
  std::vector<FilterCount> filters;
  TrackingResult tracking;
  StageTimes times;

  /// Whether the frame was unwrapped, filtered and tracked: it is neither damaged nor repeated.
  bool is_prepared() const { return damage.empty() && !repeats; }
};

/// A map that could not be joined with the others of its recording, because none of their places
/// was recognised with certainty. World coordinates are those of its first camera.
struct SeparateMap {
  Trajectory trajectory;  ///< world_from_camera of every frame registered in it
  Trajectory keyframes;   ///< world_from_camera of the keyframes
  MapCloud surface;
};

/// A map of a room, with the records of all frames. World coordinates are those of its first
/// camera. If tracking was lost and the maps before and after could not be joined, it is the map
/// with the most frames.
struct RoomMap {
  Trajectory trajectory;                   ///< world_from_camera of every registered frame
  Trajectory keyframes;                    ///< world_from_camera of the keyframes
  MapCloud surface;                        ///< in world coordinates
  std::vector<SeparateMap> separate_maps;  ///< the other maps, that with the most frames first
  std::vector<Loop> loops;                 ///< all loops that were found, used or not
  int joins = 0;                           ///< RoomMapper::joins()
  int blind_joins = 0;                     ///< RoomMapper::blind_joins()
  int joins_taken_back = 0;                ///< RoomMapper::joins_taken_back()
  PoseCertainty least_certain;             ///< RoomMapper::least_certain(); zero without keyframes
  int registered_slowly = 0;               ///< number of frames that converged_slowly()
  std::vector<FrameRecord> frames;         ///< all frames, in order
  ErrorSurvey errors;                      ///< MapRun::errors at the end of the run
  bool interrupted = false;                ///< a hook ended the run early

  int damaged() const;       ///< number of frames that could not be read
  int repeated() const;      ///< number of frames that repeat the frame before them
  int degenerate() const;    ///< number of frames with a degenerate direction of motion
  int separate() const;      ///< number of frames that are registered in separate maps
  int unused_loops() const;  ///< number of loops that the poses of the keyframes do not follow
};

/// Whether nearly all frames are registered in one map, few of them slowly, and do not contradict
/// each other, as far as its consistency measures can tell. Then wrap counts are right, apart from
/// few.
bool frames_agree(const RoomMap& map, const Consistency& consistency);

/// The evidence for the verdict on a map without ground truth. `warnings` are those about the
/// recording and the map.
MapEvidence evidence_of(const RoomMap& map, const PipelineOptions& options,
                        const Consistency& consistency, const std::vector<std::string>& warnings);

/// Throws InputError if more than half of the frames are damaged. The message quotes
/// `first_damage`.
void refuse_mostly_damaged(int damaged, int total, const std::string& first_damage);
void refuse_mostly_damaged(const RoomMap& map);

/// Functions that a run calls. Each of them may be empty. An exception that a hook throws ends the
/// run and is passed on.
struct MapHooks {
  /// Called before each batch of frames with the number of frames done so far. The run ends early
  /// if it returns false.
  std::function<bool(int frames_done)> keep_going;
  /// Called with every frame that was unwrapped, in order, before it is registered.
  std::function<void(const DualFrequencyFrame& recorded, const PreparedFrame&)> on_frame;
  /// Called after a frame in which something moves was registered, with the index of the frame and
  /// its cloud without the surface of what moves (Motion::still).
  std::function<void(int index, const SurfaceCloud& still)> on_motion;
};

/// A run that maps a room from frames. It can be interrupted, saved, and resumed later.
class MapRun {
 public:
  /// Throws UsageError if the options for unwrapping are not allowed.
  MapRun(const SensorModel& sensor, const PipelineOptions& options);

  /// Processes frames from the source until the source ends or a hook ends the run. Frames that
  /// are damaged or cannot be registered are skipped; their records say why. Frames are prepared
  /// in parallel and registered in order. The result is the same for any number of threads.
  void advance(FrameSource& source, const MapHooks& hooks = {});

  /// The records of all frames processed so far, in order.
  const std::vector<FrameRecord>& frames() const { return frames_; }

  /// Whether a hook ended the last call of advance().
  bool is_interrupted() const { return is_interrupted_; }

  /// The camera's errors, surveyed over the frames since the run was started or resumed.
  ErrorSurvey errors() const { return errors_.survey(); }

  /// The map so far.
  const RoomMapper& mapper() const { return mapper_; }

  /// Saves what is needed to resume the run. A run with the same sensor and options that loads it
  /// continues to the same map, to the bit; errors() starts again without frames. Only the build
  /// that wrote the data can read it. load() throws std::exception if the data is damaged.
  void save(std::ostream& out) const;
  void load(std::istream& in);

  /// The map of the frames processed so far. The run ends with this call: advance() and save() must
  /// not be called afterwards.
  RoomMap finish();

 private:
  std::vector<SourcedFrame> take_next(FrameSource& source);
  std::vector<bool> find_repeats(const std::vector<SourcedFrame>& frames);
  void add(const PreparedFrame& frame, const MapHooks& hooks);

  SensorModel sensor_;
  PipelineOptions options_;
  PixelRays rays_;
  RoomMapper mapper_;
  FrameMeasurer measurer_;
  ErrorTally errors_;
  std::vector<SourcedFrame> ahead_;    ///< frames measured ahead that are still to be mapped
  std::vector<Unwrapper> unwrappers_;  ///< one per thread
  std::vector<FrameRecord> frames_;
  DualFrequencyFrame last_;  ///< the last frame that could be read and repeats none; empty at first
  bool is_interrupted_ = false;
};

/// Maps all frames of a source: a MapRun from start to finish.
RoomMap map_room(FrameSource& source, const PipelineOptions& options, const MapHooks& hooks = {});

}  // namespace tofmap
