// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include "output/frame_report.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include <nlohmann/json.hpp>

#include <tofmap/diagnostics/recording_survey.hpp>

namespace tofmap::app {

nlohmann::ordered_json consistency_json(const Consistency& consistency) {
  return {{"residual_misfit_percent", json_number(consistency.residual_misfit_percent)},
          {"residual_rms_cycles", json_number(consistency.residual_rms_cycles)},
          {"ambiguous_percent", json_number(consistency.ambiguous_percent)},
          {"contradicted_percent", json_number(consistency.contradicted_percent)},
          {"plane_thickness_m", json_number(consistency.plane_thickness_m)},
          {"view_disagreement_m", json_number(consistency.view_disagreement_m)},
          {"curl_violations_per_frame", json_number(consistency.curl_violations_per_frame)}};
}

nlohmann::ordered_json judgement_json(const Judgement& judgement) {
  return {{"verdict", name_of(judgement.verdict)},
          {"reasons", judgement.reasons},
          {"remarks", judgement.remarks}};
}

std::vector<std::string> all_warnings(const SourceSurvey& source, const RoomMap& map,
                                      const Consistency& consistency) {
  const bool map_agrees = frames_agree(map, consistency);
  std::vector<std::string> warnings = warnings_about(source, &map.errors, map_agrees);
  if (auto warning = repetition_warning(map.repeated())) warnings.push_back(*std::move(warning));
  std::ranges::move(warnings_about(map.errors, map_agrees), std::back_inserter(warnings));
  std::ranges::move(warnings_about(consistency), std::back_inserter(warnings));
  return warnings;
}

}  // namespace tofmap::app
