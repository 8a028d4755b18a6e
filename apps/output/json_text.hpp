// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace tofmap::app {

/// The text of a JSON file. Bytes in strings that are not valid UTF-8 become U+FFFD.
std::string json_text(const nlohmann::ordered_json& json);

}  // namespace tofmap::app
