// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "recorded_path.hpp"

#include "inner_path.hpp"

#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {

std::filesystem::path recorded_path(const std::string& text) {
  if (text.empty() || text.find('\0') != std::string::npos) {
    throw InputError("the path is empty or not valid");
  }
  return inner_path(text, "recording");
}

}  // namespace tofmap::kinect2
