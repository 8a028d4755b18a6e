// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/wrap_count_confidence.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The calibration curves: log odds that a wrap count is right, at the log odds of its belief in
/// `believed_odds`. There is one curve for each noise of the residual, from 1/32 to 2 residual
/// steps. With low noise, medium odds occur mostly at edges, so the curves are flat there. Fitted
/// to the development data of `bench_unwrap_accuracy --grid`: 15 places with 15 cameras each, at
/// full and at half image size. Between the points the curves are linear; the first and the last
/// segment are extrapolated.
constexpr std::array<float, 8> believed_odds{-4, 0, 8, 14, 18, 45, 65, 85};
using Curve = std::array<float, believed_odds.size()>;
constexpr std::array<Curve, 5> curves{{{-2.1F, 0.1F, 0.3F, 0.4F, 6.3F, 7.6F, 10.3F, 11},
                                       {-2.1F, 0.5F, 1.1F, 1.2F, 6, 7.5F, 10.2F, 10.8F},
                                       {-2.4F, 0.2F, 1.9F, 2.1F, 5.5F, 8.1F, 10, 10.6F},
                                       {-3.2F, -0.1F, 3.5F, 4.8F, 7.3F, 8.7F, 9, 10.5F},
                                       {-2.5F, -0.2F, 2, 4.2F, 5.4F, 7.1F, 8.4F, 10.5F}}};
constexpr float first_noise_octaves = -5;
constexpr float curve_octaves = 1.5F;  ///< step of the noise from one curve to the next

/// A curve as a line with changes of its slope at the inner points.
struct BentLine {
  float start = 0;
  float slope = 0;
  std::array<float, believed_odds.size() - 2> bends{};
};

constexpr auto bent_lines = [] {
  std::array<BentLine, curves.size()> lines{};
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto slope_after = [&](std::size_t k) {
      return (curves[c][k + 1] - curves[c][k]) / (believed_odds[k + 1] - believed_odds[k]);
    };
    lines[c].start = curves[c][0];
    lines[c].slope = slope_after(0);
    for (std::size_t k = 0; k < lines[c].bends.size(); ++k) {
      lines[c].bends[k] = slope_after(k + 1) - slope_after(k);
    }
  }
  return lines;
}();

/// The inputs of the calibration for successive pixels.
struct Pixels {
  const float* best;    ///< probability of the chosen wrap count
  const float* others;  ///< probability of all other wrap counts together
  const float* sigma_a_cycles;
  const std::uint8_t* counts;
  const float* odds_factor;  ///< of the log odds, if these are positive
};

/// Log odds of a pixel with three or more frequencies count this much more than the curves say, and
/// with each jump to a neighbour this much less. Fitted by maximum likelihood to three `random`
/// scenes (seeds 11 to 13), with noise of 5 to 30 mm at 5 m, with and without systematic errors.
constexpr float odds_factor_without_jump = 1.1F;
constexpr float odds_factor_of_jump = 0.2F;

/// 1 where the range between two pixels jumps, 0 where it does not or one of them has none.
TOFMAP_VECTOR_CLONES void find_jumps(int count, const float* range_m, const float* neighbour_m,
                                     float* jumps) {
  constexpr float least_m = 0.3F;
  constexpr float least_share = 0.02F;  // surfaces at a grazing angle
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float difference_m = range_m[i] - neighbour_m[i];
    const float size_m = difference_m < 0 ? -difference_m : difference_m;
    const float least = least_m + 0.5F * least_share * (range_m[i] + neighbour_m[i]);
    jumps[i] = size_m > least ? 1.0F : 0.0F;
  }
}

/// The factors of the log odds of the pixels of a row, from the jumps to their four neighbours.
TOFMAP_VECTOR_CLONES void fill_odds_factor(int count, const float* left, const float* above,
                                           const float* below, float* odds_factor) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float jumps = left[i] + left[i + 1] + above[i] + below[i];
    odds_factor[i] = odds_factor_without_jump - odds_factor_of_jump * jumps;
  }
}

/// `steps_per_cycle` is the noise of the residual in residual steps if A's phase has a noise of one
/// cycle.
TOFMAP_VECTOR_CLONES void fill_confidence(int count, const Pixels& pixels_, float steps_per_cycle,
                                          float* confidence) {
  const Pixels pixels = pixels_;
  constexpr float least = 1e-37F;  // smaller numbers are not normal floats
  constexpr auto last_curve = static_cast<float>(curves.size() - 1);
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float other = pixels.others[i] > least ? pixels.others[i] : least;
    const float believed = std::numbers::ln2_v<float> * (log2_of(pixels.best[i]) - log2_of(other));
    const float noise = steps_per_cycle * pixels.sigma_a_cycles[i];
    const float share = noise > least ? noise : least;
    const float place = (log2_of(share) - first_noise_octaves) / curve_octaves;
    const float at_least_first = place > 0 ? place : 0;
    const float curve = at_least_first < last_curve ? at_least_first : last_curve;
    float right = 0;
#pragma GCC unroll 8
    for (std::size_t c = 0; c < curves.size(); ++c) {
      const BentLine& line = bent_lines[c];
      float odds = line.start + line.slope * (believed - believed_odds[0]);
#pragma GCC unroll 8
      for (std::size_t k = 0; k < line.bends.size(); ++k) {
        const float beyond = believed - believed_odds[k + 1];
        odds += line.bends[k] * (beyond > 0 ? beyond : 0);
      }
      const float off = curve - static_cast<float>(c);
      const float weight = 1 - (off > 0 ? off : -off);
      right += (weight > 0 ? weight : 0) * odds;
    }
    right = right > 0 ? right * pixels.odds_factor[i] : right;
    const float odds_against = exp_of_negative(right > 0 ? -right : right);
    const float probability = (right > 0 ? 1 : odds_against) / (1 + odds_against);
    confidence[i] = pixels.counts[i] == invalid_wrap_count ? 0 : probability;
  }
}

}  // namespace

ImageF wrap_count_confidence(const WrapCountBeliefs& beliefs, const ImageF& range_m,
                             const ImageF& sigma_a_cycles, const UnwrapLimits& limits) {
  const auto steps_per_cycle = static_cast<float>(residual_noise_steps(limits));
  const Eigen::Index rows = beliefs.count.rows();
  const Eigen::Index cols = beliefs.count.cols();
  const auto width = static_cast<int>(cols);
  const auto size = static_cast<std::size_t>(cols);
  // Across the border of the image there is no jump.
  std::vector<float> left(size + 1, 0.0F);
  std::vector<float> above(size, 0.0F);
  std::vector<float> below(size, 0.0F);
  std::vector<float> odds_factor(size, 1.0F);
  ImageF confidence(rows, cols);
  for (Eigen::Index v = 0; v < rows; ++v) {
    const Eigen::Index at = v * cols;
    if (limits.frequencies() > 2) {
      const float* row = range_m.data() + at;
      find_jumps(width - 1, row + 1, row, left.data() + 1);
      std::ranges::fill(below, 0.0F);
      if (v + 1 < rows) find_jumps(width, row, row + cols, below.data());
      fill_odds_factor(width, left.data(), above.data(), below.data(), odds_factor.data());
      above.swap(below);
    }
    fill_confidence(width,
                    {beliefs.probability.data() + at, beliefs.other_probability.data() + at,
                     sigma_a_cycles.data() + at, beliefs.count.data() + at, odds_factor.data()},
                    steps_per_cycle, confidence.data() + at);
  }
  return confidence;
}

}  // namespace tofmap
