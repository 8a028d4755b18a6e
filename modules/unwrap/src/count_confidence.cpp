// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "count_confidence.hpp"

#include "fast_math.hpp"

#include <array>
#include <cstddef>
#include <numbers>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// A point of the curve from log odds of beliefs to log odds of being right.
struct Knot {
  float believed;
  float right;
};

/// Read off the shares of right counts of the development grid of bench_unwrap_accuracy, with
/// other pairs of frequencies besides: 13 places, 34 cameras each. Lines join the knots; the first
/// and the last go on.
constexpr std::array<Knot, 8> curve{{{-4, -2.3F},
                                     {0, -0.3F},
                                     {8, 2.2F},
                                     {14, 3.1F},
                                     {18, 4.4F},
                                     {45, 5.4F},
                                     {65, 8.3F},
                                     {85, 10.5F}}};

constexpr float slope_after(std::size_t knot) {
  return (curve[knot + 1].right - curve[knot].right) /
         (curve[knot + 1].believed - curve[knot].believed);
}

/// By how much the slope changes at every inner knot.
constexpr auto bends = [] {
  std::array<float, curve.size() - 2> changes{};
  for (std::size_t k = 0; k < changes.size(); ++k) {
    changes[k] = slope_after(k + 1) - slope_after(k);
  }
  return changes;
}();

TOFMAP_VECTOR_CLONES void fill_confidence(int pixels, const float* best, const float* others,
                                          const std::uint8_t* counts, float* confidence) {
  constexpr float least = 1e-37F;  // smaller numbers are no normal floats
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float other = others[i] > least ? others[i] : least;
    const float believed = std::numbers::ln2_v<float> * (log2_of(best[i]) - log2_of(other));
    float right = curve[0].right + slope_after(0) * (believed - curve[0].believed);
    for (std::size_t k = 0; k < bends.size(); ++k) {
      const float beyond = believed - curve[k + 1].believed;
      right += bends[k] * (beyond > 0 ? beyond : 0);
    }
    const float odds_against = exp_of_negative(right > 0 ? -right : right);
    const float share = (right > 0 ? 1 : odds_against) / (1 + odds_against);
    confidence[i] = counts[i] == invalid_wrap_count ? 0 : share;
  }
}

}  // namespace

ImageF count_confidence(const CountBeliefs& beliefs) {
  ImageF confidence(beliefs.count.rows(), beliefs.count.cols());
  fill_confidence(static_cast<int>(confidence.size()), beliefs.probability.data(),
                  beliefs.other_probability.data(), beliefs.count.data(), confidence.data());
  return confidence;
}

}  // namespace tofmap
