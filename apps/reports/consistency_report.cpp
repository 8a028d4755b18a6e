// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include "output/frame_report.hpp"

#include <nlohmann/json.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
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
