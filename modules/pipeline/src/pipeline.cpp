// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/pipeline/pipeline.hpp"

#include "tofmap/pipeline/recording_survey.hpp"
#include "tofmap/pipeline/side_by_side.hpp"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include <omp.h>

namespace tofmap {
namespace {

/// Runs a step and adds its duration, in milliseconds, to `spent_ms`.
template <class Step>
auto timed(double& spent_ms, const Step& step) {
  /// Adds up when it goes, so that steps may return nothing.
  struct Timer {
    double& spent_ms;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    ~Timer() {
      const auto end = std::chrono::steady_clock::now();
      spent_ms += std::chrono::duration<double, std::milli>(end - start).count();
    }
  };
  const Timer timer{spent_ms};
  return step();
}

/// Up to `count` frames from the source, fewer at its end.
std::vector<SourcedFrame> take(FrameSource& source, int count) {
  std::vector<SourcedFrame> frames;
  while (static_cast<int>(frames.size()) < count) {
    std::optional<SourcedFrame> frame = source.next();
    if (!frame) break;
    frames.push_back(std::move(*frame));
  }
  return frames;
}

/// Measures frames in their order and prepares them side by side; damaged ones stay empty.
std::vector<std::optional<PreparedFrame>> prepare_all(const std::vector<SourcedFrame>& frames,
                                                      FrameMeasurer& measurer, ErrorTally& errors,
                                                      std::vector<Unwrapper>& unwrappers,
                                                      const SensorModel& sensor,
                                                      const PixelRays& rays,
                                                      const PipelineOptions& options) {
  std::vector<std::optional<TimedMeasurement>> measured;
  for (const SourcedFrame& sourced : frames) {
    measured.push_back(sourced.frame ? std::optional(measure_frame(*sourced.frame, measurer))
                                     : std::nullopt);
    if (measured.back()) errors.add(measured.back()->frame);
  }
  return side_by_side(
      static_cast<int>(frames.size()), unwrappers, [&](Unwrapper& unwrapper, int i) {
        const auto& frame = measured[static_cast<std::size_t>(i)];
        return frame ? std::optional(prepare_frame(*frame, unwrapper, sensor, rays, options))
                     : std::nullopt;
      });
}

/// The first frames of a recording tell what the camera is like.
void look_ahead(const std::vector<SourcedFrame>& first, FrameMeasurer& measurer) {
  std::vector<DualFrequencyFrame> frames;
  for (const SourcedFrame& sourced : first) {
    if (sourced.frame && frames.size() < FrameMeasurer::frames_ahead) {
      frames.push_back(*sourced.frame);
    }
  }
  measurer.look_ahead(frames);
}

FrameRecord damaged_record(const SourcedFrame& frame) {
  FrameRecord record;
  record.index = frame.index;
  record.timestamp_s = frame.timestamp_s;
  record.damage = frame.damage;
  return record;
}

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

/// Places one frame and, if that succeeds, adds it to the map.
FrameRecord place(const PreparedFrame& frame, RoomMapper& mapper) {
  FrameRecord record = prepared_record(frame);
  record.tracking = timed(record.times.register_ms, [&] {
    return mapper.track(frame.index, frame.timestamp_s, frame.cloud);
  });
  if (!record.tracking.placed()) return record;
  timed(record.times.map_ms, [&] { mapper.integrate(*frame.cloud); });
  timed(record.times.loop_ms, [&] { mapper.close_loops(); });
  return record;
}

}  // namespace

void bind_options(OptionTable& table, PipelineOptions& options) {
  table.bind("unwrap", options.unwrap);
  table.bind("filters", options.filters);
  table.bind("cloud", options.cloud);
  table.bind("registration", options.registration);
  table.bind("odometry", options.odometry);
  table.bind("loops", options.loops);
  table.bind("map", options.map);
}

int RoomMap::repeated() const {
  return static_cast<int>(std::ranges::count_if(frames, &FrameRecord::repeats));
}

int RoomMap::damaged() const {
  return static_cast<int>(std::ranges::count_if(
      frames, [](const FrameRecord& record) { return !record.damage.empty(); }));
}

TimedMeasurement measure_frame(const DualFrequencyFrame& frame, FrameMeasurer& measurer) {
  TimedMeasurement out;
  out.frame = timed(out.milliseconds, [&] { return measurer.measure(frame); });
  return out;
}

PreparedFrame prepare_ranges(const TimedMeasurement& measured, Unwrapper& unwrapper,
                             const SensorModel& sensor, const PixelRays& rays,
                             const PipelineOptions& options) {
  const DualFrequencyFrame& returns = measured.frame.returns;
  PreparedFrame out;
  out.index = returns.index;
  out.timestamp_s = returns.timestamp_s;
  out.times.unwrap_ms = measured.milliseconds;
  out.unwrapped = timed(out.times.unwrap_ms, [&] { return unwrapper.unwrap(measured.frame); });
  out.filtered = timed(out.times.filter_ms, [&] {
    return apply_filters(out.unwrapped.image, returns, sensor.modulation, rays, options.filters);
  });
  // Wrapped ranges are those of a camera that knows of no wraps: how likely they are right would
  // tell registration what only unwrapping knows.
  if (options.unwrap.method == "none") out.filtered.image.confidence.setOnes();
  return out;
}

PreparedFrame prepare_frame(const TimedMeasurement& measured, Unwrapper& unwrapper,
                            const SensorModel& sensor, const PixelRays& rays,
                            const PipelineOptions& options) {
  PreparedFrame out = prepare_ranges(measured, unwrapper, sensor, rays, options);
  out.cloud = timed(out.times.cloud_ms, [&] {
    return std::make_shared<const SurfaceCloud>(
        surface_cloud(out.filtered.image, rays, options.cloud));
  });
  return out;
}

MapRun::MapRun(const SensorModel& sensor, const PipelineOptions& options)
    : sensor_(sensor),
      options_(options),
      rays_(pixel_rays(sensor.camera)),
      mapper_(sensor.camera, options.odometry, options.registration, options.loops, options.map),
      measurer_(sensor, options.unwrap),
      unwrappers_(one_a_thread(Unwrapper(sensor, options.unwrap))) {}

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
    const auto prepared =
        prepare_all(frames, measurer_, errors_, unwrappers_, sensor_, rays_, options_);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (prepared[i] && hooks.on_frame) hooks.on_frame(*prepared[i]);
      frames_.push_back(prepared[i] ? place(*prepared[i], mapper_) : damaged_record(frames[i]));
      if (!prepared[i]) continue;
      frames_.back().repeats = repeats(*frames[i].frame, last_);
      last_ = *std::move(frames[i].frame);
    }
  }
}

/// The next frames, one a thread: those that were looked at ahead come first.
std::vector<SourcedFrame> MapRun::take_next(FrameSource& source) {
  const auto wanted = static_cast<std::size_t>(omp_get_max_threads());
  if (ahead_.empty()) return take(source, static_cast<int>(wanted));
  const auto end = ahead_.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, ahead_.size()));
  std::vector<SourcedFrame> frames(std::make_move_iterator(ahead_.begin()),
                                   std::make_move_iterator(end));
  ahead_.erase(ahead_.begin(), end);
  return frames;
}

RoomMap MapRun::finish() {
  mapper_.finish();
  RoomMap map;
  map.trajectory = mapper_.trajectory();
  map.keyframes = mapper_.keyframe_trajectory();
  map.surface = mapper_.surface();
  map.loops = mapper_.loops();
  map.frames = std::move(frames_);
  map.errors = errors_.survey();
  map.interrupted = is_interrupted_;
  return map;
}

RoomMap map_room(FrameSource& source, const PipelineOptions& options, const MapHooks& hooks) {
  MapRun run(source.sensor(), options);
  run.advance(source, hooks);
  return run.finish();
}

}  // namespace tofmap
