// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/verdict.hpp>
#include <tofmap/diagnostics/error_survey.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/mapping/room_mapper.hpp>
#include <tofmap/pipeline/localisation.hpp>
#include <tofmap/pipeline/room_map.hpp>
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

/// A frame that has been unwrapped, filtered and turned into a cloud, but not registered yet.
struct PreparedFrame {
  int index = 0;
  double timestamp_s = 0;
  Frame returns;  ///< the phases that were unwrapped: MeasuredFrame::returns
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
TimedMeasurement measure_frame(const Frame& frame, FrameMeasurer& measurer);

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

/// Functions that a run calls. Each of them may be empty. An exception that a hook throws ends the
/// run and is passed on.
struct MapHooks {
  /// Called before each batch of frames with the number of frames done so far. The run ends early
  /// if it returns false.
  std::function<bool(int frames_done)> keep_going;
  /// Called with every frame that was unwrapped, in order, before it is registered.
  std::function<void(const Frame& recorded, const PreparedFrame&)> on_frame;
  /// Called after a frame in which something moves was registered, with the index of the frame and
  /// its cloud without the surface of what moves (Motion::still).
  std::function<void(int index, const SurfaceCloud& still)> on_motion;
};

/// Throws UsageError if the method is to find absolute wrap counts, which the single frequency of
/// the sensor does not determine (are_absolute): surfaces would be at wrong ranges.
void check_mappable(const SensorModel& sensor, const UnwrapOptions& options);

/// A run that maps a room from frames. It can be interrupted, saved, and resumed later.
class MapRun {
 public:
  /// Throws UsageError if the options for unwrapping are not allowed, and as check_mappable() does.
  /// `source` is the name of the recording or device, for the map's file.
  MapRun(const SensorModel& sensor, const PipelineOptions& options, const std::string& source = "");

  /// Goes on with a finished map (RoomMapper::go_on_with()). Must be called before the first frame.
  /// Throws UsageError if the map was made with another camera.
  void go_on_with(MapContent finished, MapUse use, std::optional<MapPlace> start = std::nullopt);

  /// Processes frames from the source until the source ends or a hook ends the run. Frames that
  /// are damaged or cannot be registered are skipped; their records say why. Frames are prepared
  /// in parallel and registered in order. The result is the same for any number of threads.
  void advance(FrameSource& source, const MapHooks& hooks = {});

  /// The records of all frames processed so far, in order.
  const std::vector<FrameRecord>& frames() const { return frames_; }

  /// Whether a hook ended the last call of advance().
  bool is_interrupted() const { return is_interrupted_; }

  /// The camera's errors, surveyed over the frames so far.
  ErrorSurvey errors() const { return errors_.survey(); }

  /// The map so far.
  const RoomMapper& mapper() const { return mapper_; }

  /// Stores the map so far and the records of the frames that have changed since note_saved().
  void save_map(MapStore::Commit& commit) const;
  /// Stores the map, and what is needed to resume the run. A run with the same sensor and options
  /// that loads it continues to the same map, to the bit. `read_frame` reads a frame of the
  /// recording by its index. load() throws InputError if what was stored is damaged; the run is
  /// then not to be used.
  void save(MapStore::Commit& commit) const;
  void load(const MapStore& store, const std::function<SourcedFrame(int index)>& read_frame);
  /// Must be called after the commit was finished.
  void note_saved() { first_unsaved_ = frames_.size(); }

  /// The map of the frames processed so far. The run ends with this call: advance() and save() must
  /// not be called afterwards.
  RoomMap finish();

  /// Says how good the map is that finish() has returned (MapRecording::verdict).
  void note_verdict(Verdict verdict) { mapper_.note_verdict(std::string(name_of(verdict))); }

  /// As finish(), for a run that was localised in a finished map (MapUse::localise).
  Localisation finish_localised();

 private:
  void finish_frames();
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
  std::size_t first_unsaved_ = 0;  ///< the first frame whose record has changed since note_saved()
  Frame last_;  ///< the last frame that could be read and repeats none; empty at first
  bool is_interrupted_ = false;
};

/// Maps all frames of a source: a MapRun from start to finish.
RoomMap map_room(FrameSource& source, const PipelineOptions& options, const MapHooks& hooks = {});

}  // namespace tofmap
