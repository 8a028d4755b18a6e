// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "oni_driver_api.hpp"

#include <cstring>

namespace tofmap {

/// Copies a value to where OpenNI2 wants it, if there is room.
template <class Value>
OniStatus answer(const Value& value, void* data, int* size) {
  if (*size < static_cast<int>(sizeof value)) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof value);
  *size = static_cast<int>(sizeof value);
  return ONI_STATUS_OK;
}

/// The value that OpenNI2 hands over; null if it is of another size.
template <class Value>
const Value* given(const void* data, int size) {
  return size == static_cast<int>(sizeof(Value)) ? static_cast<const Value*>(data) : nullptr;
}

}  // namespace tofmap
