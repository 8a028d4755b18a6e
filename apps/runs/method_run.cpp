// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runs/method_run.hpp"

#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/sampled_frames.hpp"
#include "output/frame_report.hpp"
#include "runs/measured_recording.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <omp.h>

#include <tofmap/pipeline/side_by_side.hpp>

namespace tofmap::app {
namespace {

UnwrappingRecord record_of_index(const UnwrapResult& unwrapped, double milliseconds,
                                 const SequenceReader& recording, const RecordedTruth& recorded,
                                 int index) {
  return record_of(unwrapped, recording.files()[static_cast<std::size_t>(index)].timestamp_s,
                   milliseconds, recorded.range_m(index),
                   recording.sensor().modulation.wavelength_a_m());
}

/// What became of a frame that was only unwrapped.
struct UnwrappedFrame {
  std::optional<UnwrappingRecord> record;
  std::string damage;
};

UnwrappedFrame unwrap_frame(const SequenceReader& recording, const RecordedTruth& recorded,
                            const MeasuredSource& source, Unwrapper& unwrapper) {
  if (!source.measured) return {std::nullopt, source.sourced.damage};
  const auto start = std::chrono::steady_clock::now();
  const UnwrapResult unwrapped = unwrapper.unwrap(source.measured->frame);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  return {record_of_index(unwrapped, source.measured->milliseconds + spent.count(), recording,
                          recorded, source.sourced.index),
          ""};
}

}  // namespace

Truth read_truth(const SequenceReader& source, const RecordedTruth& recorded, bool quiet) {
  Truth truth;
  truth.poses = recorded.poses();
  truth.surface = ReferenceSurface(origin_near(truth.poses));
  const PixelRays rays = pixel_rays(source.sensor().camera);
  constexpr int every = 3;  // neighbouring frames see the same surface
  Progress progress("reading truth, frame", source.frame_count(), quiet);
  for (int i = 0; i < *source.frame_count(); i += every) {
    stop_if_interrupted();
    progress.show(i);
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

MethodResult run_down_to_map(const std::string& method, const SequenceReader& recording,
                             PipelineOptions options, const RecordedTruth& recorded,
                             const Truth& truth, bool quiet) {
  MethodResult result;
  result.name = method;
  options.unwrap.method = method;
  SequenceReader source(recording.folder(), recording.calibration());
  Progress progress("method " + method + ", frame", source.frame_count(), quiet);
  MapHooks hooks;
  hooks.keep_going = [&](int done) {
    progress.show(done);
    return !is_interrupted();
  };
  hooks.on_frame = [&](const PreparedFrame& frame) {
    result.frames.push_back(
        record_of_index(frame.unwrapped, frame.times.unwrap_ms, recording, recorded, frame.index));
  };
  result.map = map_room(source, options, hooks);
  refuse_mostly_damaged(*result.map);
  result.interrupted = result.map->interrupted;
  if (result.interrupted) return result;
  result.consistency = consistency_of(*result.map,
                                      sampled_frames(recording, *recording.frame_count(),
                                                     consistency_frames(recording.sensor().camera)),
                                      recording.sensor(), options);
  result.scores = score_of(*result.map, truth);
  return result;
}

MethodResult run_unwrapping(const std::string& method, const SequenceReader& recording,
                            UnwrapOptions options, const RecordedTruth& recorded, bool quiet) {
  MethodResult result;
  result.name = method;
  options.method = method;
  const int total = *recording.frame_count();
  auto unwrappers = one_a_thread(Unwrapper(recording.sensor(), options));
  MeasuredRecording measured(recording, options);
  Progress progress("method " + method + ", frame", total, quiet);
  int done = 0;
  std::string first_damage;
  while (done < total && !is_interrupted()) {
    const int end = std::min(total, done + omp_get_max_threads());
    const std::vector<MeasuredSource> sources = measured.read(done, end);
    const auto unwrap_one = [&](Unwrapper& unwrapper, int i) {
      return unwrap_frame(recording, recorded, sources[static_cast<std::size_t>(i)], unwrapper);
    };
    for (const UnwrappedFrame& frame : side_by_side(end - done, unwrappers, unwrap_one)) {
      if (frame.record) result.frames.push_back(*frame.record);
      if (first_damage.empty()) first_damage = frame.damage;
    }
    progress.show(done = end);
  }
  refuse_mostly_damaged(done - static_cast<int>(result.frames.size()), done, first_damage);
  result.interrupted = done < total;
  return result;
}

}  // namespace tofmap::app
