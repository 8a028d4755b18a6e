// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/json_text.hpp"

#include <nlohmann/json.hpp>

namespace tofmap::app {

std::string json_text(const nlohmann::ordered_json& json) {
  constexpr int indent = 1;
  constexpr bool ascii_only = false;
  using Handler = nlohmann::ordered_json::error_handler_t;
  return json.dump(indent, ' ', ascii_only, Handler::replace) + "\n";
}

}  // namespace tofmap::app
