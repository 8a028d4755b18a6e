// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/plane_edge_filter.hpp"

#include "inverse_depth.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The pixels before a row's pixels in one direction, averaged: the next one, and the one after it.
struct Direction {
  const float* next;
  const float* next_variance;
  const float* second;
  const float* second_variance;
};

/// Sets a bit where the two pixels of a direction predict the pixel.
TOFMAP_VECTOR_CLONES void predict(int pixels, const float* value, const float* variance,
                                  const Direction& from_, float max_sigmas2, float tolerance2,
                                  int bit, int* agrees) {
  const Direction from = from_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float predicted = 2 * from.next[i] - from.second[i];
    const float off = value[i] - predicted;
    const float noise = variance[i] + 4 * from.next_variance[i] + from.second_variance[i];
    // Noise of depths is that of inverse depths by their fourth power.
    const float square = predicted * predicted;
    const float tolerated = (max_sigmas2 * noise + tolerance2) * square * square;
    agrees[i] |= off * off <= tolerated ? bit : 0;
  }
}

constexpr int directions = 8;
constexpr int axes = directions / 2;

/// From a pixel to its neighbours, counter-clockwise from the right; opposite ones are `axes`
/// apart.
std::array<int, directions> neighbour_offsets(int below) {
  return {1, 1 - below, -below, -below - 1, -1, below - 1, below, below + 1};
}

/// For each pixel the directions whose next two pixels predict it, a bit each.
class Predictions {
 public:
  Predictions(const InverseDepth& depth, const InverseDepth& smooth, const PlaneEdgeLimits& limits)
      : stride_(depth.stride()),
        agrees_(static_cast<std::size_t>((depth.rows() + 2 * margin) * stride_)) {
    const auto step = neighbour_offsets(stride_);
    const auto max_sigmas2 = static_cast<float>(limits.max_sigmas * limits.max_sigmas);
    const auto tolerance2 = static_cast<float>(limits.tolerance_m * limits.tolerance_m);
    for (int v = 0; v < depth.rows(); ++v) {
      for (std::size_t d = 0; d < directions; ++d) {
        predict(depth.cols(), depth.value(v), depth.variance(v),
                {smooth.value(v) + step[d], smooth.variance(v) + step[d],
                 smooth.value(v) + 2 * step[d], smooth.variance(v) + 2 * step[d]},
                max_sigmas2, tolerance2, 1 << d, agrees_.data() + place(v, 0));
      }
    }
  }

  /// Whether three adjacent directions agree.
  bool agree_in_a_sector(int row, int col) const {
    const unsigned bits = static_cast<unsigned>(agrees_[place(row, col)]);
    const unsigned twice = bits | bits << directions;
    return (bits & twice >> 1 & twice >> 2) != 0;
  }

  /// The axes along which both directions agree, a bit each; none outside the image.
  int lines(int row, int col) const {
    const int bits = agrees_[place(row, col)];
    return bits & bits >> axes;
  }

 private:
  static constexpr int margin = 1;

  std::size_t place(int row, int col) const {
    return static_cast<std::size_t>((row + margin) * stride_ + margin + col);
  }

  int stride_;
  std::vector<int> agrees_;
};

/// Whether a pixel and one beside it are parts of two parallel lines that are equally deep: a strip
/// two pixels wide.
bool lies_on_a_strip(int row, int col, const InverseDepth& depth, const InverseDepth& smooth,
                     const Predictions& predictions, float tolerance_m) {
  constexpr float noise = 1.5F;  // tighter than for predictions, which need not be that near
  const int lines = predictions.lines(row, col);
  if (lines == 0) return false;
  const auto step = neighbour_offsets(depth.stride());
  constexpr std::array<int, directions> rows{0, -1, -1, -1, 0, 1, 1, 1};
  constexpr std::array<int, directions> cols{1, 1, 0, -1, -1, -1, 0, 1};
  for (std::size_t d = 0; d < directions; ++d) {
    const int along = 1 << d % axes;  // both lie on this line anyhow
    const int common = lines & predictions.lines(row + rows[d], col + cols[d]) & ~along;
    if (common == 0) continue;
    const float gap_m = 1 / depth.value(row)[col] - 1 / *(depth.value(row) + col + step[d]);
    const float variance = depth.variance(row)[col] + *(smooth.variance(row) + col + step[d]);
    if (gap_m * gap_m <= tolerance_m * tolerance_m + noise * noise * variance) return true;
  }
  return false;
}

}  // namespace

RangeImage drop_off_planes(const RangeImage& image, const PixelRays& rays,
                           const PlaneEdgeLimits& limits) {
  // Stricter than for smoothing: what is left out only adds noise, what is taken in wrongly moves
  // predictions.
  constexpr PairAverage average{.max_sigmas = 2.5, .tolerance_m = 0.005};
  const InverseDepth depth(image, rays);
  const InverseDepth smooth = averaged_over_pairs(depth, average);
  const Predictions predictions(depth, smooth, limits);
  const auto tolerance_m = static_cast<float>(limits.tolerance_m);
  RangeImage out = image;
  for (int v = 0; v < depth.rows(); ++v) {
    for (int u = 0; u < depth.cols(); ++u) {
      if (!image.valid(v, u) || predictions.agree_in_a_sector(v, u)) continue;
      if (lies_on_a_strip(v, u, depth, smooth, predictions, tolerance_m)) continue;
      out.invalidate(v, u, InvalidReason::jump_edge);
    }
  }
  return out;
}

}  // namespace tofmap
