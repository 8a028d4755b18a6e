// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/plane_edge_filter.hpp"

#include "inverse_depth.hpp"

#include <algorithm>
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

/// Sets `agrees` to 1 where the two pixels of a direction predict the pixel, else to 0.
TOFMAP_VECTOR_CLONES void predict(int pixels, const float* value, const float* variance,
                                  const Direction& from_, float max_sigmas2, float tolerance2,
                                  int* agrees) {
  const Direction from = from_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float predicted = 2 * from.next[i] - from.second[i];
    const float off = value[i] - predicted;
    const float noise = variance[i] + 4 * from.next_variance[i] + from.second_variance[i];
    // Noise of depths is that of inverse depths by their fourth power.
    const float square = predicted * predicted;
    const float tolerated = (max_sigmas2 * noise + tolerance2) * square * square;
    agrees[i] = off * off <= tolerated ? 1 : 0;
  }
}

/// Adds 1 where three directions in a row agree.
TOFMAP_VECTOR_CLONES void add_sectors(int pixels, const int* first, const int* second,
                                      const int* third, int* sectors) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) sectors[i] += first[i] & second[i] & third[i];
}

}  // namespace

RangeImage drop_off_planes(const RangeImage& image, const PixelRays& rays,
                           const PlaneEdgeLimits& limits) {
  // Stricter than for smoothing: what is left out only adds noise, what is taken in wrongly moves
  // predictions.
  constexpr PairAverage average{.max_sigmas = 2.5, .tolerance_m = 0.005};
  constexpr std::size_t directions = 8;
  const InverseDepth depth(image, rays);
  const InverseDepth smooth = averaged_over_pairs(depth, average);
  const int below = depth.stride();
  const std::array<int, directions> step{1,  1 - below, -below, -below - 1,
                                         -1, below - 1, below,  below + 1};
  const auto max_sigmas2 = static_cast<float>(limits.max_sigmas * limits.max_sigmas);
  const auto tolerance2 = static_cast<float>(limits.tolerance_m * limits.tolerance_m);
  const auto cols = static_cast<std::size_t>(depth.cols());
  std::array<std::vector<int>, directions> agrees;
  agrees.fill(std::vector<int>(cols));
  std::vector<int> sectors(cols);
  RangeImage out = image;
  for (int v = 0; v < depth.rows(); ++v) {
    for (std::size_t d = 0; d < directions; ++d) {
      predict(depth.cols(), depth.value(v), depth.variance(v),
              {smooth.value(v) + step[d], smooth.variance(v) + step[d],
               smooth.value(v) + 2 * step[d], smooth.variance(v) + 2 * step[d]},
              max_sigmas2, tolerance2, agrees[d].data());
    }
    std::ranges::fill(sectors, 0);
    for (std::size_t d = 0; d < directions; ++d) {
      add_sectors(depth.cols(), agrees[d].data(), agrees[(d + 1) % directions].data(),
                  agrees[(d + 2) % directions].data(), sectors.data());
    }
    for (int u = 0; u < depth.cols(); ++u) {
      if (image.valid(v, u) && sectors[static_cast<std::size_t>(u)] == 0) {
        out.invalidate(v, u, InvalidReason::jump_edge);
      }
    }
  }
  return out;
}

}  // namespace tofmap
