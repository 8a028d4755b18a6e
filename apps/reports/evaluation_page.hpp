// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/watched_source.hpp"
#include "options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/evaluation/method_run.hpp>

namespace tofmap::app {

/// The contents of the page of an evaluation.
struct EvaluationPageSubject {
  const SequenceReader& recording;
  const RecordedTruth& recorded_truth;
  const Truth& truth;
  const std::vector<MethodResult>& results;  ///< not empty
  const nlohmann::ordered_json& report;      ///< of `results` (evaluation_report.hpp)
  const SourceSurvey& survey;                ///< of the recording
  std::vector<std::string> warnings;         ///< about the evaluation
  const ProgramOptions& options;
  std::string options_yaml;
};

/// Writes report.html into a result that is already in place. The page shows the effect of
/// unwrapping on ranges, path and map. Throws InputError if it cannot be written.
void write_evaluation_page(const std::filesystem::path& result,
                           const EvaluationPageSubject& subject);

}  // namespace tofmap::app
