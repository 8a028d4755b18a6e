// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/own_counts.hpp"

#include "common/fast_math.hpp"
#include "joint/count_likelihood.hpp"
#include "joint/edge_ratio.hpp"

#include <algorithm>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Phases are clear if the unary factor of the second most likely wrap count is at most this large.
constexpr float clear = 1e-3F;

/// A wrap count is certain if the neighbours with clear phases make it this much more likely, by
/// the product of the pairwise factors along the edges to them. One edge has at most 10^6, so this
/// takes three neighbours.
constexpr float certain_support = 1e15F;

/// What a block of pixels gets.
struct Found {
  std::uint8_t* count;
  float* likelihood;    ///< of `count`, by equation 11
  float* cycles;        ///< range of the first frequency, in its wavelengths; NaN without a return
  float* odds_against;  ///< by the pixel's own phases; 1 where they are not clear
};

TOFMAP_VECTOR_CLONES void write(int pixels, const float* phase, const std::uint8_t* mixed,
                                const count_likelihood::Candidates& candidates_,
                                const CountLikelihood::Block& likelihood_,
                                const CountLikelihood::Block& next_likelihood_, float other_counts,
                                const Found& found_) {
  const Found found = found_;
  const float* count = candidates_.count.data();
  const float* likelihood = likelihood_.data();
  const float* next_likelihood = next_likelihood_.data();
  const float floor = other_counts * least_unary_factor;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float share = next_likelihood[i] / likelihood[i];
    const float squared = share * share;
    const float tempered = squared * squared;
    const bool is_clear = tempered <= clear && phase[i] == phase[i] && mixed[i] == 0;
    found.likelihood[i] = likelihood[i];
    found.count[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(count[i]));
    found.cycles[i] = phase[i] + count[i];
    found.odds_against[i] = is_clear ? tempered + floor : 1.0F;
  }
}

/// Successive pixels whose phases have been unwrapped by themselves.
struct Unwrapped {
  const float* cycles;
  const float* sigma_cycles;
  const float* amplitude;
  const float* odds_against;
};

/// The roots of the pairwise factors along the edges between pixels and one neighbour of each; 1 if
/// the phases of either are not clear.
TOFMAP_VECTOR_CLONES void fill_support(int pixels, const Unwrapped& from_, const Unwrapped& to_,
                                       const EdgeScale& scale_, float* support) {
  const Unwrapped from = from_;
  const Unwrapped to = to_;
  const EdgeScale scale = scale_;
  const float variance_scale = scale.wavelength_m * scale.wavelength_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    // NaN where there is no return, which is not clear.
    const float difference = to.cycles[i] - from.cycles[i];
    const float variance =
        from.sigma_cycles[i] * from.sigma_cycles[i] + to.sigma_cycles[i] * to.sigma_cycles[i];
    const float odds = from.odds_against[i];
    const float other_odds = to.odds_against[i];
    const float greater = odds > other_odds ? odds : other_odds;
    const bool are_clear = greater <= 1.1F * clear;
    const float variance_m2 = are_clear ? variance * variance_scale : 1.0F;
    const EdgeRatio ratio(scale, variance_m2, from.amplitude[i], to.amplitude[i]);
    const float r = ratio(are_clear ? difference : 0.0F);
    const float squared = r * r;
    const float bounded = squared < largest_root_ratio ? squared : largest_root_ratio;
    const float raised = bounded > 1 ? bounded : 1.0F;
    support[i] = are_clear ? raised : 1.0F;
  }
}

/// Finds certain pixels of a row, and replaces the odds against their wrap counts by those of their
/// beliefs. `before` and `after` are the supports along the edges to opposite neighbours.
TOFMAP_VECTOR_CLONES void finish_row(int pixels, const float* left, const float* right,
                                     const float* above, const float* below,
                                     const float* odds_against, std::uint8_t* certain,
                                     float* belief_against) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float support = left[i] * right[i] * (above[i] * below[i]);
    certain[i] = support >= certain_support ? 1 : 0;
    belief_against[i] = odds_against[i] / support;
  }
}

}  // namespace

OwnCounts find_own_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                          const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                          const ImageU8& mixed) {
  const Eigen::Index rows = frame.rows();
  const Eigen::Index cols = frame.cols();
  OwnCounts out{ImageU8(rows, cols), ImageU8(rows, cols), ImageF(rows, cols), ImageF(rows, cols)};
  ImageF cycles(rows, cols);
  ImageF odds_against(rows, cols);
  CountLikelihood likelihoods(frame, limits, sigma, residual_sigma_m, prior.outlier_share);
  CountLikelihood::Block likelihood;
  CountLikelihood::Block next_likelihood;
  const auto other_counts = static_cast<float>(std::max(limits.count - 2, 0));
  constexpr Eigen::Index block_pixels = count_likelihood::block_pixels;
  for (Eigen::Index at = 0; at < cycles.size(); at += block_pixels) {
    const auto pixels = static_cast<int>(std::min(block_pixels, cycles.size() - at));
    likelihoods.go_to(at, pixels);
    const count_likelihood::Candidates& candidates = likelihoods.find_candidates();
    likelihoods.find(candidates.count, likelihood);
    likelihoods.find(candidates.next_count, next_likelihood);
    write(pixels, frame.phases[0].data() + at, mixed.data() + at, candidates, likelihood,
          next_likelihood, other_counts,
          {out.count.data() + at, out.likelihood.data() + at, cycles.data() + at,
           odds_against.data() + at});
  }

  const EdgeScale scale(limits, prior);
  const ImageF unknown_amplitude =
      frame.has_amplitude() ? ImageF() : ImageF::Ones(rows, cols).eval();
  const ImageF& amplitude = frame.has_amplitude() ? frame.amplitudes[0] : unknown_amplitude;
  const auto unwrapped = [&](Eigen::Index at) {
    return Unwrapped{cycles.data() + at, sigma.cycles[0].data() + at, amplitude.data() + at,
                     odds_against.data() + at};
  };
  const auto width = static_cast<int>(cols);
  // Supports along edges across the border of the image stay 1.
  std::vector<float> across(static_cast<std::size_t>(cols) + 1, 1.0F);
  std::vector<float> above(static_cast<std::size_t>(cols), 1.0F);
  std::vector<float> below(static_cast<std::size_t>(cols), 1.0F);
  for (Eigen::Index v = 0; v < rows; ++v) {
    const Eigen::Index at = v * cols;
    fill_support(width - 1, unwrapped(at), unwrapped(at + 1), scale, across.data() + 1);
    if (v + 1 < rows) {
      fill_support(width, unwrapped(at), unwrapped(at + cols), scale, below.data());
    } else {
      std::ranges::fill(below, 1.0F);
    }
    finish_row(width, across.data(), across.data() + 1, above.data(), below.data(),
               odds_against.data() + at, out.certain.data() + at, out.odds_against.data() + at);
    above.swap(below);
  }
  return out;
}

}  // namespace tofmap
