// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oni_driver_api.hpp"

#include <cstring>
#include <span>

namespace tofmap {

/// Copies values into OpenNI2's buffer of `*size` bytes and sets `*size`. Returns
/// ONI_STATUS_BAD_PARAMETER if the buffer is too small.
template <class Value>
OniStatus answer(std::span<const Value> values, void* data, int* size) {
  const auto bytes = static_cast<int>(values.size_bytes());
  if (*size < bytes) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, values.data(), values.size_bytes());
  *size = bytes;
  return ONI_STATUS_OK;
}

/// The same for a single value.
template <class Value>
OniStatus answer(const Value& value, void* data, int* size) {
  return answer(std::span<const Value>(&value, 1), data, size);
}

/// The value in OpenNI2's buffer. Null if the buffer has another size than the value.
template <class Value>
const Value* given(const void* data, int size) {
  return size == static_cast<int>(sizeof(Value)) ? static_cast<const Value*>(data) : nullptr;
}

}  // namespace tofmap
