// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/block_counts.hpp"

#include "joint/count_cost.hpp"
#include "joint/edge_ratio.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The pairwise factor's root between a pixel and its block from which on they are on one surface.
constexpr float same_surface = 1e4F;

/// A wrap count contradicts a pixel's phases if it costs this much more than the best one, nats:
/// its unary factor is 0.03.
constexpr float contradicting_cost = 3.5F / evidence_exponent;

/// No wrap count.
constexpr float none = -1;

/// Pixels that are uncertain, and the blocks that they are in, whose wrap counts are certain.
struct Pairs {
  std::size_t size = 0;
  std::array<int, count_cost::block_pixels> pixel;  ///< places in the image, row by row
  std::array<int, count_cost::block_pixels> block;
  CountCost::Block phase;        ///< of the pixels
  CountCost::Block cycles;       ///< of the blocks, with their wrap counts
  CountCost::Block variance_m2;  ///< sum of both
  CountCost::Block amplitude;    ///< of the pixels
  CountCost::Block block_amplitude;
};

/// The wrap counts that put pixels beside their blocks; `none` where there are none.
TOFMAP_VECTOR_CLONES void find_counts(const Pairs& pairs_, const EdgeScale& scale_,
                                      float last_count, float* counts) {
  const Pairs& pairs = pairs_;
  const EdgeScale scale = scale_;
  const std::size_t size = pairs.size;
#pragma GCC ivdep
  for (std::size_t i = 0; i < size; ++i) {
    const float phase = pairs.phase[i];
    const float cycles = pairs.cycles[i];
    // Rounded; neither is negative by more than a half.
    const auto nearest = static_cast<std::int32_t>(cycles - phase + 0.5F);
    const auto rounded = static_cast<float>(nearest);
    const float count = rounded < last_count ? rounded : last_count;
    const EdgeRatio ratio(scale, pairs.variance_m2[i], pairs.amplitude[i],
                          pairs.block_amplitude[i]);
    const float root = ratio(phase + count - cycles);
    counts[i] = root * root >= same_surface ? count : none;
  }
}

}  // namespace

void take_block_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                       const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                       const ImageU8& mixed, const NoisyFrame& blocks, const OwnCounts& of_blocks,
                       OwnCounts& own) {
  const EdgeScale scale(limits, prior);
  const auto last_count = static_cast<float>(limits.count - 1);
  CountCost costs(frame, limits, sigma, residual_sigma_m, prior.outlier_share, mixed);
  CountCost::Block count;
  Pairs pairs;
  const auto match = [&] {
    find_counts(pairs, scale, last_count, count.data());
    costs.go_to({pairs.pixel.data(), pairs.size});
    const CountCost::Block& cost = costs.find(count);
    for (std::size_t i = 0; i < pairs.size; ++i) {
      if (count[i] == none) continue;
      const int at = pairs.pixel[i];
      if (cost[i] > own.cost.data()[at] + contradicting_cost) continue;
      own.count.data()[at] = static_cast<std::uint8_t>(count[i]);
      own.certain.data()[at] = 1;
      own.odds_against.data()[at] = of_blocks.odds_against.data()[pairs.block[i]];
    }
    pairs.size = 0;
  };
  const auto squared_m2 = static_cast<float>(limits.wavelength_m() * limits.wavelength_m());
  const auto amplitude = [](const Frame& image, int at) {
    return image.has_amplitude() ? image.amplitudes[0].data()[at] : 1.0F;
  };
  const auto cols = static_cast<int>(frame.cols());
  const auto block_cols = static_cast<int>(blocks.frame.cols());
  for (int row = 0; row < static_cast<int>(frame.rows()); ++row) {
    for (int col = 0; col < cols; ++col) {
      const int at = row * cols + col;
      const int block = row / 2 * block_cols + col / 2;
      const float phase = frame.phases[0].data()[at];
      const int settled = own.certain.data()[at] + mixed.data()[at];
      if (settled != 0 || of_blocks.certain.data()[block] == 0 || std::isnan(phase)) continue;
      const std::size_t i = pairs.size++;
      const float own_sigma = sigma.cycles[0].data()[at];
      const float its_sigma = blocks.sigma.cycles[0].data()[block];
      pairs.pixel[i] = at;
      pairs.block[i] = block;
      pairs.phase[i] = phase;
      pairs.cycles[i] =
          blocks.frame.phases[0].data()[block] + static_cast<float>(of_blocks.count.data()[block]);
      pairs.variance_m2[i] = (own_sigma * own_sigma + its_sigma * its_sigma) * squared_m2;
      pairs.amplitude[i] = amplitude(frame, at);
      pairs.block_amplitude[i] = amplitude(blocks.frame, block);
      if (pairs.size == pairs.pixel.size()) match();
    }
  }
  match();
}

}  // namespace tofmap
