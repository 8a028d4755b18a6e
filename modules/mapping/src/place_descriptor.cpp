// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/place_descriptor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {

PlaceDescriptor::PlaceDescriptor() { log_range_.fill(nan); }

PlaceDescriptor::PlaceDescriptor(const SurfaceCloud& cloud) : PlaceDescriptor() {
  std::vector<float> ranges;
  for (std::size_t cell = 0; cell < log_range_.size(); ++cell) {
    const std::size_t first_row = cell / cols * cloud.height / rows;
    const std::size_t last_row = (cell / cols + 1) * cloud.height / rows;
    const std::size_t first_col = cell % cols * cloud.width / cols;
    const std::size_t last_col = (cell % cols + 1) * cloud.width / cols;
    ranges.clear();
    for (std::size_t row = first_row; row < last_row; ++row) {
      for (std::size_t col = first_col; col < last_col; ++col) {
        const SurfacePoint& point = cloud.points[row * cloud.width + col];
        if (point.has_normal()) ranges.push_back(point.getVector3fMap().norm());
      }
    }
    const std::size_t pixels = (last_row - first_row) * (last_col - first_col);
    if (ranges.empty() || 2 * ranges.size() < pixels) continue;
    log_range_[cell] = std::log(median(ranges));
  }
}

double PlaceDescriptor::difference(const PlaceDescriptor& other) const {
  double sum = 0;
  std::size_t shared = 0;
  for (std::size_t i = 0; i < log_range_.size(); ++i) {
    const float off = std::abs(log_range_[i] - other.log_range_[i]);
    if (std::isnan(off)) continue;
    sum += off;
    ++shared;
  }
  if (2 * shared < log_range_.size()) return std::numeric_limits<double>::infinity();
  return sum / static_cast<double>(shared);
}

std::string PlaceDescriptor::to_bytes() const {
  return {reinterpret_cast<const char*>(log_range_.data()), sizeof log_range_};
}

PlaceDescriptor place_from_bytes(std::string_view bytes) {
  PlaceDescriptor place;
  if (bytes.size() != sizeof place.log_range_) {
    throw InputError("the descriptor of a place has another size");
  }
  std::memcpy(place.log_range_.data(), bytes.data(), bytes.size());
  constexpr float largest = 100;  // of the logarithm of a range
  const auto is_plausible = [](float value) { return !(std::abs(value) > largest); };  // may be NaN
  if (!std::ranges::all_of(place.log_range_, is_plausible)) {
    throw InputError("the descriptor of a place has numbers that are not plausible");
  }
  return place;
}

}  // namespace tofmap
