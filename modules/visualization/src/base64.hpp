// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tofmap {

/// Base64 as in RFC 4648, with padding and without line breaks.
std::string base64(const void* data, std::size_t size);

/// Base64 of the bytes of values in memory.
template <class Value>
std::string base64(const std::vector<Value>& values) {
  return base64(values.data(), values.size() * sizeof(Value));
}

}  // namespace tofmap
