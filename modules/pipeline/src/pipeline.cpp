// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/pipeline.hpp"

#include "tofmap/core/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <iterator>
#include <optional>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <omp.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/timed.hpp>
#include <tofmap/mapping/contradicted_loops.hpp>

namespace tofmap {
namespace {

/// Takes the next `count` frames from the source, or fewer at its end.
std::vector<SourcedFrame> take(FrameSource& source, int count) {
  std::vector<SourcedFrame> frames;
  while (static_cast<int>(frames.size()) < count) {
    std::optional<SourcedFrame> frame = source.next();
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

/// Measures frames in order and prepares them in parallel. Returns one entry per frame, which is
/// empty if the frame is damaged or repeats the frame before it.
std::vector<std::optional<PreparedFrame>> prepare_all(
    const std::vector<SourcedFrame>& frames, const std::vector<bool>& repeats,
    FrameMeasurer& measurer, ErrorTally& errors, std::vector<Unwrapper>& unwrappers,
    const SensorModel& sensor, const PixelRays& rays, const PipelineOptions& options) {
  std::vector<std::optional<TimedMeasurement>> measured;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    measured.emplace_back();
    if (!frames[i].frame || repeats[i]) continue;
    measured.back() = measure_frame(*frames[i].frame, measurer);
    errors.add(measured.back()->frame);
  }
  return side_by_side(
      static_cast<int>(frames.size()), unwrappers, [&](Unwrapper& unwrapper, int i) {
        auto& frame = measured[static_cast<std::size_t>(i)];
        return frame ? std::optional(
                           prepare_frame(*std::move(frame), unwrapper, sensor, rays, options))
                     : std::nullopt;
      });
}

/// Estimates the camera's errors from the first frames of a recording.
void look_ahead(const std::vector<SourcedFrame>& first, FrameMeasurer& measurer) {
  std::vector<Frame> frames;
  for (const SourcedFrame& sourced : first) {
    if (sourced.frame && frames.size() < FrameMeasurer::frames_ahead) {
      frames.push_back(*sourced.frame);
    }
  }
  measurer.look_ahead(frames);
}

/// The baseline without unwrapping is mapped as far as it goes: wrapped surfaces contradict each
/// other, as if they moved, so that checks of poses would leave nothing to compare.
OdometryOptions odometry_of(const PipelineOptions& options) {
  OdometryOptions odometry = options.odometry;
  if (options.unwrap.method == UnwrapMethod::none) {
    odometry.check_poses = false;
    odometry.leave_out_moving = false;
  }
  return odometry;
}

/// The record of a frame that was not unwrapped.
FrameRecord plain_record(const SourcedFrame& frame) {
  FrameRecord record;
  record.index = frame.index;
  record.timestamp_s = frame.timestamp_s;
  record.damage = frame.damage;
  return record;
}

/// The record of a frame that was unwrapped, but not registered yet.
FrameRecord prepared_record(const PreparedFrame& frame) {
  FrameRecord record;
  record.index = frame.index;
  record.timestamp_s = frame.timestamp_s;
  record.iterations = frame.unwrapped.iterations;
  record.curl_violations = frame.unwrapped.curl_violations;
  record.phase_noise_cycles = frame.unwrapped.phase_noise_cycles;
  record.valid_pixels = frame.unwrapped.image.count_valid();
  record.kept_pixels = frame.filtered.image.count_valid();
  record.filters = frame.filtered.counts;
  record.times = frame.times;
  return record;
}

/// What a record keeps of the tracking of a frame.
FrameTracking kept(const TrackingResult& tracking) {
  return {.status = tracking.status,
          .is_keyframe = tracking.is_keyframe,
          .registration = tracking.registration};
}

/// Tells the mapper about a frame that repeats the frame before it, and returns its record.
FrameRecord repeated(const SourcedFrame& frame, RoomMapper& mapper) {
  FrameRecord record = plain_record(frame);
  record.repeats = true;
  record.tracking = kept(mapper
                             .add_frame({.index = frame.index,
                                         .timestamp_s = frame.timestamp_s,
                                         .cloud = nullptr,
                                         .repeats = true})
                             .tracking);
  return record;
}

/// What a map tells of its recording.
MapRecording described(const std::string& source, const SensorModel& sensor,
                       PipelineOptions options) {
  OptionTable table;
  bind_options(table, options);
  return {.source = source,
          .added = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))),
          .version = TOFMAP_VERSION,
          .options = table.to_yaml(false),
          .sensor = sensor};
}

/// Throws UsageError unless the cameras of a map and of a recording are the same.
void check_same_camera(const CameraModel& of_map, const CameraModel& camera) {
  if (are_same_camera(of_map, camera)) return;
  throw UsageError(fmt::format(
      "the map was made with another camera: {} x {} px, focal length {:.1f} px, and the recording "
      "has {} x {} px, {:.1f} px; record with the same camera",
      of_map.width_px, of_map.height_px, of_map.fx_px, camera.width_px, camera.height_px,
      camera.fx_px));
}

/// Whether a loop between the last recording and earlier ones, which is used, moved what was there
/// before.
bool has_moved_map(const MapContent& content) {
  auto loop = content.loops.begin();
  for (const PoseEdge& edge : content.edges) {
    if (!edge.may_be_wrong) continue;
    const auto is_new = [&](int id) {
      return content.keyframes[id].recording + 1 == std::ssize(content.recordings);
    };
    if (is_new(edge.to) != is_new(edge.from) && loop->is_used &&
        loop->error_m > KeyframeGraph::well_connected_sigma_m) {
      return true;
    }
    ++loop;
  }
  return false;
}

const SensorModel& checked(const SensorModel& sensor, const UnwrapOptions& options) {
  check_mappable(sensor, options);
  return sensor;
}

}  // namespace

void check_mappable(const SensorModel& sensor, const UnwrapOptions& options) {
  if (sensor.modulation.count() > 1 || options.method == UnwrapMethod::none) return;
  const UnwrapLimits limits = unwrap_limits(sensor, options.max_range_m);
  if (are_absolute(limits)) return;
  throw UsageError(fmt::format(
      "a map needs absolute ranges, but the recording has one modulation frequency, which tells "
      "wrap counts only relative to each other; record at two or more frequencies, or, if no "
      "surface is farther than {0:.2f} m, set unwrap.max_range_m={0:.2f}",
      std::floor(100 * limits.wavelength_m()) / 100));
}

void bind_options(OptionTable& table, PipelineOptions& options) {
  table.bind("unwrap", options.unwrap);
  table.bind("filters", options.filters);
  table.bind("cloud", options.cloud);
  table.bind("registration", options.registration);
  table.bind("odometry", options.odometry);
  table.bind("loops", options.loops);
  table.bind("map", options.map);
}

TimedMeasurement measure_frame(const Frame& frame, FrameMeasurer& measurer) {
  TimedMeasurement out;
  out.frame = timed(out.milliseconds, [&] { return measurer.measure(frame); });
  return out;
}

PreparedFrame prepare_ranges(TimedMeasurement measured, Unwrapper& unwrapper,
                             const SensorModel& sensor, const PixelRays& rays,
                             const PipelineOptions& options) {
  PreparedFrame out;
  out.times.unwrap_ms = measured.milliseconds;
  out.unwrapped = timed(out.times.unwrap_ms, [&] { return unwrapper.unwrap(measured.frame); });
  out.returns = std::move(measured.frame.returns);
  out.index = out.returns.index;
  out.timestamp_s = out.returns.timestamp_s;
  out.filtered = timed(out.times.filter_ms, [&] {
    return apply_filters(out.unwrapped.image, out.returns, sensor.modulation, rays,
                         options.filters);
  });
  // Method `none` is the baseline without unwrapping: its confidence must not tell registration
  // which ranges are wrapped.
  if (options.unwrap.method == UnwrapMethod::none) out.filtered.image.confidence.setOnes();
  return out;
}

PreparedFrame prepare_frame(TimedMeasurement measured, Unwrapper& unwrapper,
                            const SensorModel& sensor, const PixelRays& rays,
                            const PipelineOptions& options) {
  PreparedFrame out = prepare_ranges(std::move(measured), unwrapper, sensor, rays, options);
  out.cloud = timed(out.times.cloud_ms, [&] {
    return std::make_shared<const SurfaceCloud>(
        surface_cloud(out.filtered.image, rays, options.cloud));
  });
  return out;
}

MapRun::MapRun(const SensorModel& sensor, const PipelineOptions& options, const std::string& source)
    : sensor_(checked(sensor, options.unwrap)),
      options_(options),
      rays_(pixel_rays(sensor.camera)),
      mapper_(sensor.camera, odometry_of(options), options.registration, options.loops,
              options.map),
      measurer_(sensor, options.unwrap),
      unwrappers_(one_a_thread(Unwrapper(sensor, options.unwrap))) {
  mapper_.describe_recording(described(source, sensor, options));
}

void MapRun::go_on_with(MapContent finished, MapUse use, std::optional<MapPlace> start) {
  check_same_camera(finished.camera, sensor_.camera);
  MapRecording recording = mapper_.content().recordings.back();
  mapper_.go_on_with(std::move(finished), std::move(recording), use, start);
}

void MapRun::advance(FrameSource& source, const MapHooks& hooks) {
  const auto may_go_on = [&] {
    is_interrupted_ = hooks.keep_going && !hooks.keep_going(static_cast<int>(frames_.size()));
    return !is_interrupted_;
  };
  while (may_go_on()) {
    if (frames_.empty() && ahead_.empty()) {
      ahead_ = take(source, FrameMeasurer::frames_ahead);
      look_ahead(ahead_, measurer_);
    }
    std::vector<SourcedFrame> frames = take_next(source);
    if (frames.empty()) break;
    const std::vector<bool> repeats = find_repeats(frames);
    const auto prepared =
        prepare_all(frames, repeats, measurer_, errors_, unwrappers_, sensor_, rays_, options_);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (prepared[i]) {
        if (hooks.on_frame) hooks.on_frame(*frames[i].frame, *prepared[i]);
        add(*prepared[i], hooks);
      } else {
        frames_.push_back(repeats[i] ? repeated(frames[i], mapper_) : plain_record(frames[i]));
      }
    }
  }
}

/// Adds a frame to the map, and its record.
void MapRun::add(const PreparedFrame& frame, const MapHooks& hooks) {
  AddedFrame added = mapper_.add_frame(
      {.index = frame.index, .timestamp_s = frame.timestamp_s, .cloud = frame.cloud});
  const auto tell_motion = [&](int index, const std::shared_ptr<const SurfaceCloud>& still) {
    if (hooks.on_motion && still && std::ranges::any_of(still->points, moves)) {
      hooks.on_motion(index, *still);
    }
  };
  for (LateFrame& late : added.late) {
    tell_motion(late.index, late.still);
    const auto record =
        std::ranges::find(frames_.rbegin(), frames_.rend(), late.index, &FrameRecord::index);
    record->tracking = kept(late.tracking);
    const auto place = static_cast<std::size_t>(frames_.rend() - record) - 1;
    first_unsaved_ = std::min(first_unsaved_, place);
  }
  FrameRecord& record = frames_.emplace_back(prepared_record(frame));
  record.tracking = kept(added.tracking);
  record.times.register_ms = added.register_ms;
  record.times.map_ms = added.integrate_ms;
  record.times.loop_ms = added.loop_ms;
  tell_motion(frame.index, added.still);
}

/// For each of the frames, whether it has the same phases as the frame before it.
std::vector<bool> MapRun::find_repeats(const std::vector<SourcedFrame>& frames) {
  std::vector<bool> repeats;
  for (const SourcedFrame& sourced : frames) {
    repeats.push_back(sourced.frame && tofmap::repeats(*sourced.frame, last_));
    if (sourced.frame && !repeats.back()) last_ = *sourced.frame;
  }
  return repeats;
}

/// The next frames, one per thread. Frames that were measured ahead come first.
std::vector<SourcedFrame> MapRun::take_next(FrameSource& source) {
  const auto wanted = static_cast<std::size_t>(omp_get_max_threads());
  if (ahead_.empty()) return take(source, static_cast<int>(wanted));
  const auto end = ahead_.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, ahead_.size()));
  std::vector<SourcedFrame> frames(std::make_move_iterator(ahead_.begin()),
                                   std::make_move_iterator(end));
  ahead_.erase(ahead_.begin(), end);
  return frames;
}

/// Ends the mapping, and tells the records in which map their frames are.
void MapRun::finish_frames() {
  mapper_.finish();
  int number_of_map = 0;
  for (const int number : maps_of(mapper_.content())) {
    ++number_of_map;
    for (const int index : frames_of(mapper_.content(), number)) {
      std::ranges::lower_bound(frames_, index, {}, &FrameRecord::index)->map = number_of_map;
    }
  }
}

RoomMap MapRun::finish() {
  finish_frames();
  const MapContent& content = mapper_.content();
  RoomMap map;
  for (const int number : maps_of(content)) {
    SeparateMap one{trajectory_of(content, number), keyframe_trajectory_of(content, number),
                    surface_of(content, number)};
    if (map.trajectory.empty()) {
      map.trajectory = std::move(one.trajectory);
      map.keyframes = std::move(one.keyframes);
      map.surface = std::move(one.surface);
      const auto certainties = certainties_of(content, number);
      map.least_certain = least_certain(certainties);
      map.uncertain =
          static_cast<int>(std::ranges::count_if(certainties, [](const PoseCertainty& frame) {
            return frame.error.position_m > most_position_sigma_m;
          }));
      std::ranges::copy_if(content.changes, std::back_inserter(map.changes),
                           [&](const MapChange& change) { return change.map == number; });
    } else {
      map.separate_maps.push_back(std::move(one));
    }
  }
  map.registered_slowly =
      static_cast<int>(std::ranges::count_if(frames_, [&](const FrameRecord& record) {
        return record.tracking.registered() &&
               converged_slowly(record.tracking.registration, options_.registration);
      }));
  map.loops = content.loops;
  map.contradicted_loops = contradicted_loops(content);
  if (content.recordings.size() > 1) map.localised = mapper_.localised_frames();
  map.has_moved_map = has_moved_map(content);
  map.nearness = mapper_.nearness();
  // The join with the map that is extended does not tell of lost tracking.
  map.joins = mapper_.joins() - (map.localised.value_or(0) > 0 ? 1 : 0);
  map.blind_joins = mapper_.blind_joins();
  map.joins_taken_back = mapper_.joins_taken_back();
  map.frames = std::move(frames_);
  map.errors = errors_.survey();
  map.interrupted = is_interrupted_;
  return map;
}

Localisation MapRun::finish_localised() {
  finish_frames();
  const MapContent& content = mapper_.content();
  Localisation result;
  if (mapper_.localised_frames() > 0) {
    const int map = maps_of(content).front();
    const Trajectory trajectory = trajectory_of(content, map);
    const auto covariances = covariances_of(content, map);
    const std::vector<int> indices = frames_of(content, map);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      result.localised.push_back({indices[i], trajectory[i], covariances[i]});
    }
    std::ranges::copy_if(
        content.changes, std::back_inserter(result.changes), [&](const MapChange& change) {
          return change.map == map && change.recording + 1 == std::ssize(content.recordings);
        });
  }
  result.nearness = mapper_.nearness();
  result.frames = std::move(frames_);
  result.interrupted = is_interrupted_;
  return result;
}

RoomMap map_room(FrameSource& source, const PipelineOptions& options, const MapHooks& hooks) {
  MapRun run(source.sensor(), options);
  run.advance(source, hooks);
  return run.finish();
}

}  // namespace tofmap
