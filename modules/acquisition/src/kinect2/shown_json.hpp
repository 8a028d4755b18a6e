// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include <tofmap/core/text.hpp>

namespace tofmap::kinect2 {

/// A value as messages show it: as JSON, the beginning of it if it is long. Of an object or array
/// only the kind, because it may be nested too deeply to be written.
inline std::string shown(const nlohmann::json& value) {
  if (value.is_structured()) return std::string("an ") + value.type_name();
  constexpr std::size_t longest = 60;
  const std::string text = value.dump();
  return text.size() <= longest ? text : valid_utf8(text.substr(0, longest)) + " ...";
}

}  // namespace tofmap::kinect2
