// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/evaluation_options.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>

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
  static const std::string methods_meaning =
      "methods to compare, separated by spaces: " + all_names<UnwrapMethod>(", ");
  return {
      {"methods", &O::methods, 0, 0, "", methods_meaning},
      {"down_to", &O::down_to, 0, 0, "", "last stage to compare"},
  };
}

std::vector<UnwrapMethod> chosen_methods(const EvaluationOptions& options) {
  std::vector<UnwrapMethod> methods;
  std::istringstream words(options.methods);
  for (std::string name; words >> name;) {
    const std::optional<UnwrapMethod> method = find_named<UnwrapMethod>(name);
    if (!method) {
      throw UsageError("option evaluation.methods: '" + name +
                       "' is not a method; allowed: " + all_names<UnwrapMethod>(" "));
    }
    if (std::ranges::find(methods, *method) != methods.end()) {
      throw UsageError("option evaluation.methods: '" + name + "' is named twice");
    }
    methods.push_back(*method);
  }
  if (methods.empty()) {
    throw UsageError("option evaluation.methods: is empty; allowed: " +
                     all_names<UnwrapMethod>(" "));
  }
  return methods;
}

}  // namespace tofmap::app
