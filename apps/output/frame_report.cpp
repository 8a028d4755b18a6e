// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/frame_report.hpp"

#include "output/coverage.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <nlohmann/json.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

Json times_json(const StageTimes& times) {
  Json json;
  for (const auto& [stage, time_ms] : stage_times) json[stage] = times.*time_ms;
  return json;
}

Json tracking_json(const FrameTracking& tracking) {
  const RegistrationFigures& registration = tracking.registration;
  return {{"status", name_of(tracking.status)},
          {"is_keyframe", tracking.is_keyframe},
          {"registration", name_of(registration.status)},
          {"iterations", registration.iterations},
          {"overlap", registration.overlap},
          {"inlier_ratio", registration.inlier_ratio},
          {"rmse_m", registration.rmse_m},
          {"residual_scale", registration.residual_scale},
          {"degenerate_directions", registration.degenerate_directions}};
}

Json loops_json(const RoomMap& map) {
  Json loops = Json::array();
  for (const Loop& loop : map.loops) {
    loops.push_back({{"from", loop.from_frame},
                     {"to", loop.to_frame},
                     {"error_m", loop.error_m},
                     {"mahalanobis_distance", loop.mahalanobis_distance},
                     {"is_used", loop.is_used}});
  }
  return loops;
}

/// The mean of a value over the frames that are neither damaged nor repeated. 0 if there are none.
double mean_of(const RoomMap& map, const std::function<double(const FrameRecord&)>& value) {
  double sum = 0;
  int count = 0;
  for (const FrameRecord& record : map.frames) {
    if (!record.is_prepared()) continue;
    sum += value(record);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

Json camera_json(const CameraErrors& camera) {
  return {{"offset_m", camera.offset_m()},
          {"periodic_rms_m", camera.periodic_rms_m},
          {"per_decade_m", camera.per_decade_m()},
          {"systematic_m", camera.systematic_m}};
}

}  // namespace

Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json damaged_json(const SourcedFrame& frame) {
  return {{"index", frame.index}, {"timestamp", frame.timestamp_s}, {"damage", frame.damage}};
}

void add_filter_counts(Json& frame, const std::vector<FilterCount>& counts) {
  Json removed = Json::object();
  Json corrected = Json::object();
  for (const FilterCount& count : counts) {
    const std::string name(name_of(count.filter));
    removed[name] = removed.value(name, 0) + count.removed;
    corrected[name] = corrected.value(name, 0) + count.corrected;
  }
  frame["removed"] = std::move(removed);
  frame["corrected"] = std::move(corrected);
}

Json frame_json(const FrameRecord& record) {
  Json json = {{"index", record.index},
               {"timestamp", record.timestamp_s},
               {"map", record.map > 0 ? Json(record.map) : Json(nullptr)}};
  if (!record.damage.empty()) {
    json["damage"] = record.damage;
    return json;
  }
  if (record.repeats) {
    json["repeats"] = true;
    return json;
  }
  json["iterations"] = record.iterations;
  json["curl_violations"] = record.curl_violations;
  json["phase_noise_cycles"] = record.phase_noise_cycles;
  json["valid_pixels"] = record.valid_pixels;
  json["kept_pixels"] = record.kept_pixels;
  add_filter_counts(json, record.filters);
  json["tracking"] = tracking_json(record.tracking);
  json["milliseconds"] = times_json(record.times);
  return json;
}

StageTimes mean_times(const RoomMap& map) {
  StageTimes mean;
  for (const auto& stage : stage_times) {
    const auto time_ms = stage.second;
    mean.*time_ms = mean_of(map, [&](const FrameRecord& record) { return record.times.*time_ms; });
  }
  return mean;
}

Json errors_json(const ErrorSurvey& survey) {
  // Those of the second frequency; with more of them, a list follows.
  Json json = camera_json(survey.cameras.size() > 1 ? survey.cameras[1] : CameraErrors());
  if (survey.cameras.size() > 2) {
    json["frequencies"] = Json::array();
    for (const CameraErrors& camera : survey.cameras) {
      json["frequencies"].push_back(camera_json(camera));
    }
  }
  json["exposure_flow_px"] = survey.flow_px;
  json["ambient_share"] = survey.ambient_share;
  json["ambient_factor"] = survey.ambient_factor;
  json["frames"] = survey.frames;
  json["remarks"] = remarks_about(survey);
  return json;
}

Json summary_json(const RoomMap& map) {
  const StageTimes mean = mean_times(map);
  return {{"frames", map.frames.size()},
          {"damaged", map.damaged()},
          {"repeated", map.repeated()},
          {"registered", map.trajectory.size()},
          {"missing", missing_json(map)},
          {"keyframes", map.keyframes.size()},
          {"frames_with_degenerate_directions", map.degenerate()},
          {"frames_registered_slowly", map.registered_slowly},
          {"frames_uncertain", map.uncertain},
          {"loops", loops_json(map)},
          {"joins",
           {{"kept", map.joins},
            {"by_look_alone", map.blind_joins},
            {"taken_back", map.joins_taken_back}}},
          {"least_certain",
           {{"frame", map.least_certain.frame},
            {"position_sigma_m", map.least_certain.error.position_m},
            {"rotation_sigma_rad", map.least_certain.error.rotation_rad}}},
          {"map_points", map.surface.size()},
          {"separate_maps", separate_maps_json(map)},
          {"interrupted", map.interrupted},
          {"milliseconds_per_frame", mean.total_ms()},
          {"milliseconds", times_json(mean)}};
}

}  // namespace tofmap::app
