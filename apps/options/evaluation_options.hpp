// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/option_table.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>

namespace tofmap::app {

/// The last stage that `evaluate` compares.
enum class EvaluatedStage { map, unwrapping };
std::span<const NamedValue<EvaluatedStage>> named_values(EvaluatedStage);

/// What `evaluate` compares, group `evaluation`.
struct EvaluationOptions {
  /// The unwrapping methods to compare, each once.
  std::vector<UnwrapMethod> methods = {UnwrapMethod::none,   UnwrapMethod::pixel,
                                       UnwrapMethod::single, UnwrapMethod::paper,
                                       UnwrapMethod::jump,   UnwrapMethod::joint};

  /// The last stage to compare.
  EvaluatedStage down_to = EvaluatedStage::map;

  static std::vector<OptionField<EvaluationOptions>> fields();
};

/// Throws UsageError if no method is to be compared, or one twice.
void check_methods(const EvaluationOptions& options);

}  // namespace tofmap::app
