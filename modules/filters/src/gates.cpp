// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/gates.hpp"

#include <algorithm>

#include <tofmap/core/error.hpp>

namespace tofmap {

RangeImage drop_low_amplitude(const RangeImage& image, const Frame& frame, double min_amplitude) {
  RangeImage out = image;
  if (!frame.has_amplitude()) return out;
  if (!same_size(image.range_m, frame.amplitudes.front())) {
    throw UsageError("amplitude filter: range image and frame differ in size");
  }
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    for (Eigen::Index col = 0; col < out.cols(); ++col) {
      const auto is_weak = [&](const ImageF& amplitude) {
        return amplitude(row, col) < min_amplitude;
      };
      if (out.valid(row, col) && std::ranges::any_of(frame.amplitudes, is_weak)) {
        out.invalidate(row, col, InvalidReason::low_amplitude);
      }
    }
  }
  return out;
}

RangeImage drop_low_confidence(const RangeImage& image, double min_confidence) {
  RangeImage out = image;
  for (Eigen::Index row = 0; row < out.rows(); ++row) {
    for (Eigen::Index col = 0; col < out.cols(); ++col) {
      if (out.valid(row, col) && out.confidence(row, col) < min_confidence) {
        out.invalidate(row, col, InvalidReason::low_confidence);
      }
    }
  }
  return out;
}

}  // namespace tofmap
