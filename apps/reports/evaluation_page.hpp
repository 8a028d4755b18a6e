// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/evaluation/method_run.hpp>

namespace tofmap::app {

/// What the page of an evaluation tells of.
struct EvaluationPageSubject {
  const SequenceReader& recording;
  const RecordedTruth& recorded_truth;
  const Truth& truth;
  const std::vector<MethodResult>& results;  ///< not empty
  const nlohmann::ordered_json& report;      ///< of them (evaluation_report.hpp)
  std::vector<std::string> warnings;
  const ProgramOptions& options;
  std::string options_yaml;
};

/// Writes report.html into a result that is in place already: what unwrapping does to ranges, path
/// and map. Throws InputError if it cannot be written.
void write_evaluation_page(const std::filesystem::path& result,
                           const EvaluationPageSubject& subject);

}  // namespace tofmap::app
