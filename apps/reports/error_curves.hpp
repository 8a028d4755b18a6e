// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tofmap/evaluation/method_run.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// The errors of one method against the truth.
struct MethodErrors {
  std::string name;             ///< of the method
  std::vector<PoseError> path;  ///< in order of time; empty if the true poses are unknown
  std::span<const UnwrappingRecord>
      frames;  ///< in order of time; those without a score are ignored
};

/// Adds plots of errors over time and over range, with one line per method, under a heading. Adds
/// nothing if no errors are known.
void add_error_curves(ReportPage& page, const std::vector<MethodErrors>& methods);

}  // namespace tofmap::app
