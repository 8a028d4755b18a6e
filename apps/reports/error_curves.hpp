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

/// How wrong one method is, where the truth is known.
struct MethodErrors {
  std::string name;
  std::vector<PoseError> path;  ///< in order of time; empty if there is none to compare
  std::span<const UnwrappingRecord> frames;  ///< in order of time; those without score do not count
};

/// Errors over time and over range, a line a method, under a heading of their own; nothing at all
/// if no error is known.
void add_error_curves(ReportPage& page, const std::vector<MethodErrors>& methods);

}  // namespace tofmap::app
