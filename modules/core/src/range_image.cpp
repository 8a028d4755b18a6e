// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/range_image.hpp"

namespace tofmap {
const char* reason_name(InvalidReason reason) {
  switch (reason) {
    case InvalidReason::none:
      return "none";
    case InvalidReason::no_return:
      return "no_return";
    case InvalidReason::low_amplitude:
      return "low_amplitude";
    case InvalidReason::low_confidence:
      return "low_confidence";
    case InvalidReason::jump_edge:
      return "jump_edge";
    case InvalidReason::out_of_range:
      return "out_of_range";
    case InvalidReason::ambiguous:
      return "ambiguous";
    case InvalidReason::saturated:
      return "saturated";
    case InvalidReason::isolated_wrap:
      return "isolated_wrap";
    case InvalidReason::outlier:
      return "outlier";
    case InvalidReason::free_space_violation:
      return "free_space_violation";
  }
  return "unknown";
}

RangeImage::RangeImage(Eigen::Index rows, Eigen::Index cols)
    : range_m(ImageF::Constant(rows, cols, nan)),
      sigma_m(ImageF::Constant(rows, cols, nan)),
      wrap_count(ImageU8::Constant(rows, cols, invalid_wrap_count)),
      confidence(ImageF::Zero(rows, cols)),
      reason(ImageU8::Constant(rows, cols, static_cast<std::uint8_t>(InvalidReason::no_return))) {}

int RangeImage::count_valid() const { return static_cast<int>((reason == 0).count()); }

void RangeImage::invalidate(Eigen::Index row, Eigen::Index col, InvalidReason why) {
  range_m(row, col) = nan;
  sigma_m(row, col) = nan;
  wrap_count(row, col) = invalid_wrap_count;
  confidence(row, col) = 0;
  reason(row, col) = static_cast<std::uint8_t>(why);
}

int count_reason(const RangeImage& image, InvalidReason reason) {
  return static_cast<int>((image.reason == static_cast<std::uint8_t>(reason)).count());
}

}  // namespace tofmap
