// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// What a place looks like, in a few numbers: median ranges of the parts of an image.
class PlaceDescriptor {
 public:
  PlaceDescriptor();  ///< of nothing
  explicit PlaceDescriptor(const SurfaceCloud& cloud);

  /// Mean difference of the logarithms of ranges, over parts that both have; 0 is the same, and it
  /// does not depend on the order. Infinite if they share less than half of the parts.
  double difference(const PlaceDescriptor& other) const;

 private:
  static constexpr std::size_t cols = 11;
  static constexpr std::size_t rows = 9;
  std::array<float, rows * cols> log_range_;  ///< NaN where there is no surface
};

}  // namespace tofmap
