// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "base64.hpp"

#include <vtkBase64Utilities.h>

namespace tofmap {

std::string base64(const void* data, std::size_t size) {
  const auto* input = static_cast<const unsigned char*>(data);
  std::string out(4 * (size / 3 + 1), '\0');
  const auto length = vtkBase64Utilities::Encode(input, static_cast<unsigned long>(size),
                                                 reinterpret_cast<unsigned char*>(out.data()), 0);
  out.resize(length);
  return out;
}

}  // namespace tofmap
