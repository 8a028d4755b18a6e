// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/fixed_pattern_report.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <tofmap/core/modulation.hpp>

namespace tofmap::app {
namespace {

bool is_stored(const PatternEstimate& estimate, bool with_one_range) {
  return estimate.is_significant() && (with_one_range || !shows_one_range(estimate));
}

/// What is said of one frequency.
std::string line_of(const PatternEstimate& estimate, bool with_one_range) {
  if (std::isnan(estimate.noise_m)) return "not found, since no pixel was measured twice";
  if (!estimate.is_significant()) {
    return fmt::format("none above its uncertainty of {:.1f} mm", 1000 * estimate.noise_m);
  }
  if (!is_stored(estimate, with_one_range)) {
    return "left out, since the ranges of pixels hardly change; record other distances, or set "
           "calibration.fixed_pattern=on";
  }
  return fmt::format("standard deviation {:.1f} mm over {} pixels, known within {:.1f} mm",
                     1000 * estimate.sigma_m, estimate.pixels, 1000 * estimate.remaining_m);
}

}  // namespace

bool shows_one_range(const PatternEstimate& estimate) {
  constexpr double most_left = 0.9;
  return estimate.periodic_share > most_left;
}

FixedPattern stored_pattern(const std::vector<PatternEstimate>& estimates, bool with_one_range) {
  const auto is_kept = [&](const PatternEstimate& one) { return is_stored(one, with_one_range); };
  if (std::ranges::none_of(estimates, is_kept)) return {};
  FixedPattern pattern;
  for (const PatternEstimate& one : estimates) {
    pattern.push_back(is_kept(one) ? one.error_m
                                   : ImageF::Zero(one.error_m.rows(), one.error_m.cols()));
  }
  return pattern;
}

std::vector<std::string> pattern_lines(const std::vector<PatternEstimate>& estimates,
                                       bool with_one_range) {
  std::vector<std::string> lines;
  for (std::size_t f = 0; f < estimates.size(); ++f) {
    lines.push_back("fixed pattern at " + frequency_name(f) + ": " +
                    line_of(estimates[f], with_one_range));
    if (is_stored(estimates[f], with_one_range) && shows_one_range(estimates[f])) {
      lines.push_back("warning: the ranges of pixels hardly change, so the pattern of " +
                      frequency_name(f) + " contains errors of the scene");
    }
  }
  return lines;
}

}  // namespace tofmap::app
