// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tofmap {

/// A square matrix of zeros and ones.
class BitMatrix {
 public:
  explicit BitMatrix(std::size_t size)
      : words_((size + 63) / 64), bits_(size * words_, std::uint64_t{0}) {}

  void set(std::size_t row, std::size_t col) {
    bits_[row * words_ + col / 64] |= std::uint64_t{1} << (col % 64);
  }

  bool operator()(std::size_t row, std::size_t col) const {
    return (bits_[row * words_ + col / 64] >> (col % 64)) & 1U;
  }

  /// Number of columns that are set in both rows.
  int common(std::size_t a, std::size_t b) const {
    const std::span first(&bits_[a * words_], words_);
    const std::span second(&bits_[b * words_], words_);
    int count = 0;
    for (std::size_t i = 0; i < words_; ++i) count += std::popcount(first[i] & second[i]);
    return count;
  }

 private:
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace tofmap
