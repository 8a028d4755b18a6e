// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>

namespace tofmap::app {

/// The last stage that `evaluate` compares.
enum class EvaluatedStage { map, unwrapping };
std::span<const NamedValue<EvaluatedStage>> named_values(EvaluatedStage);

/// What `evaluate` compares, group `evaluation`.
struct EvaluationOptions {
  /// Names of the unwrapping methods to compare, separated by spaces.
  std::string methods = "none pixel single paper jump joint";

  /// The last stage to compare.
  EvaluatedStage down_to = EvaluatedStage::map;

  static std::vector<OptionField<EvaluationOptions>> fields();
};

/// The methods that `options.methods` names, in the order given. Throws UsageError if a name is
/// unknown or is given twice, or if there are none.
std::vector<UnwrapMethod> chosen_methods(const EvaluationOptions& options);

}  // namespace tofmap::app
