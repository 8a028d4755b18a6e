// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include "output/frame_report.hpp"

#include <nlohmann/json.hpp>

namespace tofmap::app {

nlohmann::ordered_json consistency_json(const Consistency& consistency) {
  return {{"residual_misfit_percent", json_number(consistency.residual_misfit_percent)},
          {"residual_rms_cycles", json_number(consistency.residual_rms_cycles)},
          {"ambiguous_percent", json_number(consistency.ambiguous_percent)},
          {"contradicted_percent", json_number(consistency.contradicted_percent)},
          {"plane_thickness_m", json_number(consistency.plane_thickness_m)},
          {"curl_violations_per_frame", json_number(consistency.curl_violations_per_frame)}};
}

nlohmann::ordered_json judgement_json(const Judgement& judgement) {
  return {{"verdict", name_of(judgement.verdict)},
          {"reasons", judgement.reasons},
          {"remarks", judgement.remarks}};
}

}  // namespace tofmap::app
