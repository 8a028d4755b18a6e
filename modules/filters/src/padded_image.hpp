// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace tofmap {

/// An image with a margin on all sides, so that neighbours need no check of the border. All pixels
/// and the margin start with `value`.
class PaddedImage {
 public:
  PaddedImage(int rows, int cols, int margin, float value = 0)
      : margin_(margin),
        stride_(cols + 2 * margin),
        values_(static_cast<std::size_t>(rows + 2 * margin) * static_cast<std::size_t>(stride_),
                value) {}

  // The first pixel of a row, −margin … rows + margin − 1. The rest of the row follows it.
  const float* row(int v) const { return values_.data() + place(v); }
  float* row(int v) { return values_.data() + place(v); }

 private:
  std::size_t place(int v) const {
    return static_cast<std::size_t>(v + margin_) * static_cast<std::size_t>(stride_) +
           static_cast<std::size_t>(margin_);
  }

  int margin_;
  int stride_;
  std::vector<float> values_;
};

}  // namespace tofmap
