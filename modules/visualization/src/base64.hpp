// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tofmap {

/// RFC 4648, padded, without line breaks.
std::string base64(const void* data, std::size_t size);

/// Of values as they lie in memory.
template <class Value>
std::string base64(const std::vector<Value>& values) {
  return base64(values.data(), values.size() * sizeof(Value));
}

}  // namespace tofmap
