// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/method_run.hpp"

#include <algorithm>

#include <omp.h>

#include <tofmap/core/side_by_side.hpp>
#include <tofmap/pipeline/measured_recording.hpp>

namespace tofmap {
namespace {

UnwrappingRecord record_of_frame(const PreparedFrame& frame, const SequenceReader& recording,
                                 const RecordedTruth& recorded) {
  return record_of(frame.unwrapped, frame.timestamp_s, frame.times.unwrap_ms,
                   recorded.range_m(frame.index), recording.sensor().modulation.wavelength_m(0));
}

/// A frame that is unwrapped but not mapped. Empty if the recorded frame is damaged.
struct UnwrappedOnly {
  std::optional<PreparedFrame> prepared;
  std::optional<UnwrappingRecord> record;
};

/// The options with an empty filter chain.
PipelineOptions without_filters(PipelineOptions options) {
  options.filters.chain.clear();
  return options;
}

bool may_go_on(const MethodRun& run, int frames_done) {
  return !run.keep_going || run.keep_going(frames_done);
}

}  // namespace

Truth read_truth(const SequenceReader& source, const RecordedTruth& recorded,
                 const std::function<void(int index)>& on_frame) {
  Truth truth;
  truth.poses = recorded.poses();
  truth.surface = ReferenceSurface(origin_near(truth.poses));
  const PixelRays rays = pixel_rays(source.sensor().camera);
  constexpr int every = 3;  // neighbouring frames see the same surface
  for (int i = 0; i < *source.frame_count(); i += every) {
    if (on_frame) on_frame(i);
    const SequenceFrameFiles& files = source.files()[static_cast<std::size_t>(i)];
    if (!files.damage.empty()) continue;
    const auto pose = pose_at(truth.poses, files.timestamp_s);
    const auto ranges = recorded.range_m(i);
    if (pose && ranges) truth.surface.add(*ranges, rays, *pose);
  }
  return truth;
}

MapScores score_of(const RoomMap& map, const Truth& truth) {
  MapScores scores;
  scores.trajectory = score_trajectory(map.trajectory, truth.poses);
  if (scores.trajectory && !truth.surface.points().empty()) {
    scores.surface = score_map(map.surface, scores.trajectory->truth_from_estimate, truth.surface);
  }
  return scores;
}

UnwrappingRecord record_of(const UnwrapResult& unwrapped, double timestamp_s, double milliseconds,
                           const std::optional<ImageF>& truth_m, double wavelength_a_m) {
  UnwrappingRecord record;
  record.timestamp_s = timestamp_s;
  record.milliseconds = milliseconds;
  record.iterations = unwrapped.iterations;
  record.converged = unwrapped.converged;
  if (truth_m) {
    record.score = score_ranges(unwrapped.image, *truth_m, wavelength_a_m);
    record.over_range.add(unwrapped.image, *truth_m, wavelength_a_m);
  }
  return record;
}

ErrorsOverRange over_range(std::span<const UnwrappingRecord> frames) {
  ErrorsOverRange sum;
  for (const UnwrappingRecord& frame : frames) sum.add(frame.over_range);
  return sum;
}

MethodResult run_down_to_map(const MethodRun& run, const SequenceReader& recording,
                             const RecordedTruth& recorded, const Truth& truth) {
  MethodResult result;
  result.method = run.method;
  result.name = name_of(run.method);
  PipelineOptions options = run.options;
  options.unwrap.method = run.method;
  SequenceReader source(recording.folder(), recording.calibration());
  const SensorModel& sensor = recording.sensor();
  FrameSample sample(sensor.camera, std::max(run.sample_frames, consistency_frames(sensor.camera)),
                     source.frame_count());
  MapHooks hooks;
  hooks.keep_going = run.keep_going;
  hooks.on_frame = [&](const Frame& frame, const PreparedFrame& prepared) {
    result.frames.push_back(record_of_frame(prepared, recording, recorded));
    sample.add(frame, prepared);
  };
  hooks.on_motion = [&](int index, const SurfaceCloud& still) { sample.drop_moving(index, still); };
  result.map = map_room(source, options, hooks);
  refuse_mostly_damaged(*result.map);
  result.interrupted = result.map->interrupted;
  if (result.interrupted) return result;
  result.consistency = consistency_of(*result.map, sample, sensor, options.unwrap.method);
  sample.thin_out(run.sample_frames);
  result.sample = sample.frames();
  result.scores = score_of(*result.map, truth);
  return result;
}

MethodResult run_unwrapping(const MethodRun& run, const SequenceReader& recording,
                            const RecordedTruth& recorded) {
  MethodResult result;
  result.method = run.method;
  result.name = name_of(run.method);
  PipelineOptions options = run.options;
  options.unwrap.method = run.method;
  const PipelineOptions unfiltered = without_filters(options);
  const SensorModel& sensor = recording.sensor();
  const PixelRays rays = pixel_rays(sensor.camera);
  const int total = *recording.frame_count();
  auto unwrappers = one_a_thread(Unwrapper(sensor, options.unwrap));
  MeasuredRecording measured(recording, options.unwrap);
  FrameSample sample(sensor.camera, run.sample_frames, total);
  int done = 0;
  std::string first_damage;
  while (done < total && may_go_on(run, done)) {
    const int end = std::min(total, done + omp_get_max_threads());
    std::vector<MeasuredSource> sources = measured.read(done, end);
    const auto unwrap_one = [&](Unwrapper& unwrapper, int i) {
      MeasuredSource& frame = sources[static_cast<std::size_t>(i)];
      if (!frame.measured) return UnwrappedOnly{};
      UnwrappedOnly out;
      out.prepared = prepare_ranges(*std::move(frame.measured), unwrapper, sensor, rays,
                                    sample.wants(frame.sourced.index) ? options : unfiltered);
      out.record = record_of_frame(*out.prepared, recording, recorded);
      return out;
    };
    const auto frames = side_by_side(end - done, unwrappers, unwrap_one);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (first_damage.empty()) first_damage = sources[i].sourced.damage;
      if (!frames[i].prepared) continue;
      result.frames.push_back(*frames[i].record);
      sample.add(*sources[i].sourced.frame, *frames[i].prepared);
    }
    done = end;
  }
  refuse_mostly_damaged(done - static_cast<int>(result.frames.size()), done, first_damage);
  result.interrupted = done < total;
  result.sample = sample.frames();
  return result;
}

}  // namespace tofmap
