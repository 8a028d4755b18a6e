// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include "input/sampled_frames.hpp"
#include "reports/frame_report.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include <tofmap/core/text.hpp>
#include <tofmap/evaluation/consistency.hpp>
#include <tofmap/pipeline/side_by_side.hpp>

namespace tofmap::app {
namespace {

/// NaN of methods that go by no jumps.
double curl_violations_per_frame(const RoomMap& map, const std::string& method) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (method != "jump" && method != "single") return nan;
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
  const auto prepare = [&](Unwrapper& unwrapper, int i) {
    const auto frame = static_cast<std::size_t>(chosen[static_cast<std::size_t>(i)]);
    PreparedFrame ranges = prepare_ranges(frames[frame], unwrapper, sensor, rays, pipeline);
    return std::pair(std::move(ranges.unwrapped.image), std::move(ranges.filtered.image));
  };
  std::vector<RangedFrame> unwrapped;
  std::vector<RangedFrame> filtered;
  auto images = side_by_side(static_cast<int>(chosen.size()), unwrappers, prepare);
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const DualFrequencyFrame& frame = frames[static_cast<std::size_t>(chosen[i])];
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

std::vector<std::string> doubts_about(const Consistency& consistency) {
  // Measured: docs/evaluation.md. NaN is no more than any limit.
  constexpr double most_contradicted_percent = 3;
  constexpr double most_misfit_percent = 10;
  std::vector<std::string> doubts;
  if (consistency.contradicted_percent > most_contradicted_percent) {
    doubts.push_back(formatted(
        "frames contradict each other in %.1f %% of what they both see: ranges or path are wrong",
        consistency.contradicted_percent));
  }
  if (consistency.beat_misfit_percent > most_misfit_percent) {
    doubts.push_back(
        formatted("%.0f %% of the pixels would fit both frequencies better with another "
                  "wrap count: wraps are wrong, or the frequencies' offsets differ "
                  "('tofmap info' tells)",
                  consistency.beat_misfit_percent));
  }
  return doubts;
}

nlohmann::ordered_json consistency_json(const Consistency& consistency) {
  return {{"beat_misfit_percent", json_number(consistency.beat_misfit_percent)},
          {"beat_residual_cycles", json_number(consistency.beat_residual_cycles)},
          {"ambiguous_percent", json_number(consistency.ambiguous_percent)},
          {"contradicted_percent", json_number(consistency.contradicted_percent)},
          {"plane_thickness_m", json_number(consistency.plane_thickness_m)},
          {"curl_violations_per_frame", json_number(consistency.curl_violations_per_frame)}};
}

}  // namespace tofmap::app
