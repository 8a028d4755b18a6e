// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tofmap {

/// The product of the sizes from index `first` on; 1 if there are none.
inline std::int64_t product(const std::vector<std::int64_t>& sizes, std::size_t first = 0) {
  std::int64_t result = 1;
  for (std::size_t i = first; i < sizes.size(); ++i) result *= sizes[i];
  return result;
}

}  // namespace tofmap
