// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "run_rows.hpp"

#include <string>

#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/core/named_value.hpp>

namespace tofmap {
namespace {

using Json = nlohmann::json;

constexpr const char* damaged_status = "damaged";

Json registration_json(const RegistrationFigures& result) {
  return {{"status", name_of(result.status)},
          {"iterations", result.iterations},
          {"correspondences", result.correspondences},
          {"overlap", result.overlap},
          {"inlier_ratio", result.inlier_ratio},
          {"rmse_m", result.rmse_m},
          {"residual_scale", result.residual_scale},
          {"degenerate_directions", result.degenerate_directions}};
}

template <class Enumeration>
Enumeration named_in(const Json& object, const char* name) {
  const auto value = find_named<Enumeration>(object.at(name).get<std::string>());
  if (!value) throw InputError(std::string("'") + name + "' has an unknown value");
  return *value;
}

RegistrationFigures registration_in(const Json& json) {
  RegistrationFigures result;
  result.status = named_in<RegistrationStatus>(json, "status");
  result.iterations = json.at("iterations").get<int>();
  result.correspondences = json.at("correspondences").get<int>();
  result.overlap = json.at("overlap").get<double>();
  result.inlier_ratio = json.at("inlier_ratio").get<double>();
  result.rmse_m = json.at("rmse_m").get<double>();
  result.residual_scale = json.at("residual_scale").get<double>();
  result.degenerate_directions = json.at("degenerate_directions").get<int>();
  return result;
}

Json filters_json(const std::vector<FilterCount>& counts) {
  Json filters = Json::array();
  for (const FilterCount& count : counts) {
    filters.push_back({{"filter", name_of(count.filter)},
                       {"reason", static_cast<int>(count.reason)},
                       {"removed", count.removed},
                       {"corrected", count.corrected}});
  }
  return filters;
}

std::vector<FilterCount> filters_in(const Json& json) {
  std::vector<FilterCount> counts;
  for (const Json& filter : json) {
    const int reason = filter.at("reason").get<int>();
    if (reason < 0 || reason > static_cast<int>(InvalidReason::free_space_violation)) {
      throw InputError("'reason' has an unknown value");
    }
    counts.push_back({.filter = named_in<Filter>(filter, "filter"),
                      .reason = static_cast<InvalidReason>(reason),
                      .removed = filter.at("removed").get<int>(),
                      .corrected = filter.at("corrected").get<int>()});
  }
  return counts;
}

FrameRecord record_in(const FrameRow& row) {
  FrameRecord record;
  record.index = row.frame;
  record.timestamp_s = row.timestamp_s;
  const Json details = Json::parse(row.details);
  if (row.status == damaged_status) {
    record.damage = details.at("damage").get<std::string>();
    return record;
  }
  const auto status = find_named<TrackingStatus>(row.status);
  if (!status) throw InputError("the status '" + row.status + "' is unknown");
  record.tracking.status = *status;
  record.repeats = *status == TrackingStatus::repeated;
  if (record.repeats) return record;
  record.iterations = details.at("iterations").get<int>();
  record.curl_violations = details.at("curl_violations").get<int>();
  record.phase_noise_cycles = details.at("phase_noise_cycles").get<double>();
  record.valid_pixels = details.at("valid_pixels").get<int>();
  record.kept_pixels = details.at("kept_pixels").get<int>();
  record.filters = filters_in(details.at("filters"));
  record.tracking.is_keyframe = details.at("is_keyframe").get<bool>();
  record.tracking.registration = registration_in(details.at("registration"));
  for (const auto& [name, time] : stage_times) {
    record.times.*time = details.at("milliseconds").at(name).get<double>();
  }
  return record;
}

}  // namespace

FrameRow frame_row(const FrameRecord& record, int recording) {
  FrameRow row{.recording = recording,
               .frame = record.index,
               .timestamp_s = record.timestamp_s,
               .status = std::string(name_of(record.tracking.status)),
               .details = "{}"};
  if (!record.damage.empty()) {
    row.status = damaged_status;
    row.details =
        Json{{"damage", record.damage}}.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  if (!record.is_prepared()) return row;
  Json times;
  for (const auto& [name, time] : stage_times) times[name] = record.times.*time;
  row.details = Json{
      {"iterations", record.iterations},
      {"curl_violations", record.curl_violations},
      {"phase_noise_cycles", record.phase_noise_cycles},
      {"valid_pixels", record.valid_pixels},
      {"kept_pixels", record.kept_pixels},
      {"filters", filters_json(record.filters)},
      {"is_keyframe", record.tracking.is_keyframe},
      {"registration", registration_json(record.tracking.registration)},
      {"milliseconds",
       times}}.dump();
  return row;
}

FrameRecord frame_record(const FrameRow& row) {
  return naming("frame " + std::to_string(row.frame), [&] {
    try {
      return record_in(row);
    } catch (const Json::exception&) {
      throw InputError("the details are damaged");
    }
  });
}

}  // namespace tofmap
