// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string_view>

#include <zlib.h>

namespace tofmap {

/// The CRC-32 of bytes that are added one after the other.
class CrcSum {
 public:
  void add(std::string_view bytes) {
    if (bytes.empty()) return;  // zlib would begin anew
    sum_ =
        crc32(sum_, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
  }

  std::uint32_t value() const { return static_cast<std::uint32_t>(sum_); }

 private:
  uLong sum_ = crc32(0, nullptr, 0);
};

}  // namespace tofmap
