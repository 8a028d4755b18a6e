// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/evaluation_options.hpp"

#include <algorithm>
#include <array>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {

std::span<const NamedValue<EvaluatedStage>> named_values(EvaluatedStage) {
  static constexpr std::array<NamedValue<EvaluatedStage>, 2> stages{
      {{"unwrapping", EvaluatedStage::unwrapping}, {"map", EvaluatedStage::map}}};
  return stages;
}

std::vector<OptionField<EvaluationOptions>> EvaluationOptions::fields() {
  using O = EvaluationOptions;
  return {
      {"methods", &O::methods, 0, 0, "", "the unwrapping methods to compare, each once"},
      {"down_to", &O::down_to, 0, 0, "", "last stage to compare"},
  };
}

void check_methods(const EvaluationOptions& options) {
  const std::vector<UnwrapMethod>& methods = options.methods;
  for (auto method = methods.begin(); method != methods.end(); ++method) {
    if (std::find(methods.begin(), method, *method) != method) {
      throw UsageError("option evaluation.methods: '" + std::string(name_of(*method)) +
                       "' is named twice");
    }
  }
  if (methods.empty()) {
    throw UsageError("option evaluation.methods: is empty; allowed: " +
                     all_names<UnwrapMethod>(" "));
  }
}

}  // namespace tofmap::app
