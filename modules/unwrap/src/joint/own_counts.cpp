// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/own_counts.hpp"

#include "common/fast_math.hpp"
#include "joint/count_cost.hpp"
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
  float* cost;          ///< of `count`, nats
  float* cycles;        ///< range of the first frequency, in its wavelengths; NaN without a return
  float* odds_against;  ///< by the pixel's own phases; 1 where they are not clear
};

TOFMAP_VECTOR_CLONES void write(int pixels, const float* phase, const std::uint8_t* mixed,
                                const count_cost::Candidates& candidates_, float other_counts,
                                const Found& found_) {
  const Found found = found_;
  const float* count = candidates_.count.data();
  const float* cost = candidates_.cost.data();
  const float* next_cost = candidates_.next_cost.data();
  const float floor = other_counts * least_unary_factor;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float least = cost[i];
    const float odds = exp_of_negative(evidence_exponent * (least - next_cost[i]));
    const float own_count = count[i];
    const float cycles = phase[i] + own_count;  // NaN without a return
    const float pure_odds = mixed[i] == 0 ? odds : 1.0F;
    const float own_odds = cycles == cycles ? pure_odds : 1.0F;
    found.cost[i] = least;
    found.count[i] = static_cast<std::uint8_t>(static_cast<std::int32_t>(own_count));
    found.cycles[i] = cycles;
    found.odds_against[i] = own_odds <= clear ? odds + floor : 1.0F;
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
/// beliefs. `left` to `below` are the supports along the edges to the neighbours.
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
  CountCost costs(frame, limits, sigma, residual_sigma_m, prior.outlier_share, mixed);
  const auto other_counts = static_cast<float>(std::max(limits.count - 2, 0));
  constexpr Eigen::Index block_pixels = count_cost::block_pixels;
  for (Eigen::Index at = 0; at < cycles.size(); at += block_pixels) {
    const auto pixels = static_cast<int>(std::min(block_pixels, cycles.size() - at));
    costs.go_to(at, pixels);
    write(pixels, frame.phases[0].data() + at, mixed.data() + at, costs.find_candidates(),
          other_counts,
          {out.count.data() + at, out.cost.data() + at, cycles.data() + at,
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
