// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// Short description of what a frame sees, for recognising places: the logarithms of the median
/// ranges in 11 x 9 parts of the image.
class PlaceDescriptor {
 public:
  PlaceDescriptor();  ///< no part has a range
  /// Describes an organised cloud. A part in which less than half of the pixels have a normal gets
  /// no range.
  explicit PlaceDescriptor(const SurfaceCloud& cloud);

  /// Mean absolute difference of the logarithms over the parts in which both have a range. 0 for
  /// equal descriptors; symmetric. Infinite if both have a range in less than half of the parts.
  double difference(const PlaceDescriptor& other) const;

  /// The ranges as bytes, from which place_from_bytes() makes an equal descriptor.
  std::string to_bytes() const;

 private:
  friend PlaceDescriptor place_from_bytes(std::string_view bytes);

  static constexpr std::size_t cols = 11;
  static constexpr std::size_t rows = 9;
  std::array<float, rows * cols> log_range_;  ///< by row, then column; NaN without a range
};

/// The descriptor whose bytes PlaceDescriptor::to_bytes() returned. Throws InputError if there are
/// more or fewer bytes.
PlaceDescriptor place_from_bytes(std::string_view bytes);

}  // namespace tofmap
