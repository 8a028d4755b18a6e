// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "evaluation_options.hpp"

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

constexpr std::array<std::string_view, 4> all_methods{"none", "pixel", "single", "jump"};

}  // namespace

std::vector<OptionField<EvaluationOptions>> EvaluationOptions::fields() {
  using O = EvaluationOptions;
  return {
      {"methods", &O::methods, 0, 0, "",
       "methods to compare, separated by spaces: none, pixel, single, jump"},
      {"down_to", &O::down_to, 0, 0, "", "how far to go", "unwrapping | map"},
  };
}

std::vector<std::string> method_names(const EvaluationOptions& options) {
  std::vector<std::string> names;
  std::istringstream words(options.methods);
  for (std::string name; words >> name;) {
    if (std::ranges::find(all_methods, name) == all_methods.end()) {
      throw UsageError("option evaluation.methods: '" + name +
                       "' is no method; allowed: none pixel single jump");
    }
    if (std::ranges::find(names, name) != names.end()) {
      throw UsageError("option evaluation.methods: '" + name + "' is named twice");
    }
    names.push_back(name);
  }
  if (names.empty()) {
    throw UsageError("option evaluation.methods: names no method; allowed: none pixel single jump");
  }
  return names;
}

}  // namespace tofmap::app
