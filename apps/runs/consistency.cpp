// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runs/consistency.hpp"

#include "input/sampled_frames.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <tofmap/evaluation/consistency.hpp>
#include <tofmap/pipeline/side_by_side.hpp>

namespace tofmap::app {
namespace {

/// NaN of methods that go by no jumps.
double curl_violations_per_frame(const RoomMap& map, const std::string& method) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto known = find_unwrap_method(method);
  if (!known || !finds_jumps(*known)) return nan;
  double sum = 0;
  int frames = 0;
  for (const FrameRecord& frame : map.frames) {
    if (!frame.damage.empty()) continue;
    sum += frame.curl_violations;
    ++frames;
  }
  return frames > 0 ? sum / frames : nan;
}

}  // namespace

Consistency unknown_consistency() {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, nan, nan, nan, nan};
}

int consistency_frames(const CameraModel& camera) {
  constexpr double most_pixels = 6e6;
  return static_cast<int>(std::clamp(most_pixels / (camera.width_px * camera.height_px), 20., 60.));
}

Consistency consistency_of(const RoomMap& map, const std::vector<DualFrequencyFrame>& frames,
                           const SensorModel& sensor, const PipelineOptions& pipeline) {
  const PixelRays rays = pixel_rays(sensor.camera);
  auto unwrappers = one_a_thread(Unwrapper(sensor, pipeline.unwrap));
  const std::vector<int> chosen =
      spread_indices(static_cast<int>(frames.size()), consistency_frames(sensor.camera));
  FrameMeasurer measurer(sensor, pipeline.unwrap);
  std::vector<TimedMeasurement> measured;
  for (const int i : chosen) {
    measured.push_back(measure_frame(frames[static_cast<std::size_t>(i)], measurer));
  }
  const auto prepare = [&](Unwrapper& unwrapper, int i) {
    PreparedFrame ranges =
        prepare_ranges(measured[static_cast<std::size_t>(i)], unwrapper, sensor, rays, pipeline);
    return std::pair(std::move(ranges.unwrapped.image), std::move(ranges.filtered.image));
  };
  std::vector<RangedFrame> unwrapped;
  std::vector<RangedFrame> filtered;
  auto images = side_by_side(static_cast<int>(chosen.size()), unwrappers, prepare);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const DualFrequencyFrame& frame = measured[i].frame.returns;
    const auto pose = pose_at(map.trajectory, frame.timestamp_s);
    unwrapped.push_back({&frame, std::move(images[i].first), pose});
    filtered.push_back({&frame, std::move(images[i].second), pose});
  }
  const BeatAgreement beat = beat_agreement(unwrapped, sensor.modulation);
  return {.beat_misfit_percent = beat.misfit_percent,
          .beat_residual_cycles = beat.residual_cycles,
          .ambiguous_percent = ambiguous_percent(unwrapped),
          .contradicted_percent = contradicted_percent(filtered, sensor.camera),
          .plane_thickness_m = plane_thickness_m(map.surface),
          .curl_violations_per_frame = curl_violations_per_frame(map, pipeline.unwrap.method)};
}

}  // namespace tofmap::app
