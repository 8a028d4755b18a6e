// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap::app {

/// What `evaluate` compares, group `evaluation`.
struct EvaluationOptions {
  std::string methods = "none pixel single paper jump joint";
  std::string down_to = "map";

  static std::vector<OptionField<EvaluationOptions>> fields();
};

/// The names in `methods`, in their order. Throws UsageError for one that is no method, for one
/// that comes twice, and if there is none.
std::vector<std::string> method_names(const EvaluationOptions& options);

}  // namespace tofmap::app
