// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "inner_path.hpp"

#include <tofmap/core/error.hpp>

namespace tofmap {

std::filesystem::path inner_path(const std::string& text, const std::string& what) {
  std::filesystem::path path = std::filesystem::path(text).lexically_normal();
  if (path.is_absolute() || *path.begin() == "..") {
    throw InputError("the path '" + text + "' leads out of the " + what +
                     "; paths are relative to its folder");
  }
  return path;
}

}  // namespace tofmap
