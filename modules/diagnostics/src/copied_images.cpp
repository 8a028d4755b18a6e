// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/diagnostics/copied_images.hpp"

#include <algorithm>
#include <cstddef>

#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

/// Whether nearly all pixels with a return have the same phase in both images.
bool are_same(const ImageF& one, const ImageF& other) {
  constexpr Eigen::Index enough = 100;
  constexpr double nearly_all = 0.98;
  const Eigen::Index returns = (one == one || other == other).count();
  const Eigen::Index same = (one == other).count();
  return returns >= enough &&
         static_cast<double>(same) >= nearly_all * static_cast<double>(returns);
}

}  // namespace

std::optional<std::string> copied_images_warning(const std::vector<Frame>& frames) {
  if (frames.empty()) return std::nullopt;
  for (std::size_t a = 0; a < frames.front().frequencies(); ++a) {
    for (std::size_t b = a + 1; b < frames.front().frequencies(); ++b) {
      const auto same = std::ranges::count_if(
          frames, [&](const Frame& frame) { return are_same(frame.phases[a], frame.phases[b]); });
      if (2 * same <= static_cast<std::ptrdiff_t>(frames.size())) continue;
      return frequency_name(a) + " and " + frequency_name(b) +
             " have the same phase images; was one of their folders copied from the other?";
    }
  }
  return std::nullopt;
}

}  // namespace tofmap
