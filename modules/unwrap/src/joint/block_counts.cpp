// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/block_counts.hpp"

#include "joint/count_likelihood.hpp"
#include "joint/edge_ratio.hpp"

#include <algorithm>
#include <cstdint>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The pairwise factor's root between a pixel and its block from which on they are on one surface.
constexpr float same_surface = 1e4F;

/// A wrap count contradicts a pixel's phases if its unary factor is smaller.
constexpr float contradicted = 0.03F;

/// No wrap count.
constexpr float none = -1;

/// Successive pixels of a row.
struct Pixels {
  const float* phase;
  const float* sigma_cycles;
  const float* amplitude;
  const std::uint8_t* certain;
  const std::uint8_t* mixed;
};

/// The blocks of successive pixels, once for each pixel.
struct Blocks {
  CountLikelihood::Block cycles;  ///< with the wrap count of the block
  CountLikelihood::Block sigma_cycles;
  CountLikelihood::Block amplitude;
  CountLikelihood::Block certain;

  /// Sets the block of the pixels 2 `pair` and 2 `pair` + 1.
  void set(std::size_t pair, float its_cycles, float its_sigma_cycles, float its_amplitude,
           bool is_certain) {
    const auto write = [pair](CountLikelihood::Block& block, float value) {
      block[2 * pair] = value;
      block[2 * pair + 1] = value;
    };
    write(cycles, is_certain ? its_cycles : 0.0F);
    write(sigma_cycles, is_certain ? its_sigma_cycles : 1.0F);
    write(amplitude, is_certain ? its_amplitude : 1.0F);
    write(certain, is_certain ? 1.0F : 0.0F);
  }
};

/// The wrap counts that put pixels beside their blocks; `none` where there are none. The first
/// pixel is the first one of its block.
TOFMAP_VECTOR_CLONES void find_counts(int pixels, const Pixels& own_, const Blocks& blocks_,
                                      const EdgeScale& scale_, float last_count, float* counts) {
  const Pixels own = own_;
  const Blocks& blocks = blocks_;
  const EdgeScale scale = scale_;
  const float squared_m2 = scale.wavelength_m * scale.wavelength_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float phase = own.phase[i];
    const float sigma = own.sigma_cycles[i];
    const float amplitude = own.amplitude[i];
    const float block_cycles = blocks.cycles[at];
    const float block_sigma = blocks.sigma_cycles[at];
    const float block_amplitude = blocks.amplitude[at];
    const float certain = blocks.certain[at];
    const float own_phase = phase == phase ? phase : 0.0F;
    // Rounded; neither is negative by more than a half.
    const auto nearest = static_cast<std::int32_t>(block_cycles - own_phase + 0.5F);
    const auto rounded = static_cast<float>(nearest);
    const float count = rounded < last_count ? rounded : last_count;
    // NaN without a return, which no comparison lets pass.
    const float variance_m2 = (sigma * sigma + block_sigma * block_sigma) * squared_m2;
    const EdgeRatio ratio(scale, variance_m2, amplitude, block_amplitude);
    const float root = ratio(own_phase + count - block_cycles);
    const float certainly = root * root >= same_surface ? certain : 0.0F;
    const int settled = own.certain[i] + own.mixed[i];
    const bool is_found = (settled == 0 ? certainly : 0.0F) > 0;
    counts[i] = is_found ? count : none;
  }
}

}  // namespace

void take_block_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                       const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
                       const ImageU8& mixed, const NoisyFrame& blocks, const OwnCounts& of_blocks,
                       OwnCounts& own) {
  const EdgeScale scale(limits, prior);
  const auto last_count = static_cast<float>(limits.count - 1);
  const ImageF ones = frame.has_amplitude() ? ImageF() : ImageF::Ones(1, frame.cols()).eval();
  CountLikelihood likelihoods(frame, limits, sigma, residual_sigma_m, prior.outlier_share);
  CountLikelihood::Block count;
  CountLikelihood::Block likelihood;
  Blocks of_their_blocks;
  constexpr Eigen::Index most_pixels = count_likelihood::block_pixels;
  static_assert(most_pixels % 2 == 0);
  const auto match = [&](Eigen::Index row, Eigen::Index col, int pixels) {
    const Eigen::Index at = row * frame.cols() + col;
    const Eigen::Index block = row / 2 * blocks.frame.cols() + col / 2;
    const Pixels of_pixels{frame.phases[0].data() + at, sigma.cycles[0].data() + at,
                           frame.has_amplitude() ? frame.amplitudes[0].data() + at : ones.data(),
                           own.certain.data() + at, mixed.data() + at};
    for (Eigen::Index pair = 0; 2 * pair < pixels; ++pair) {
      const Eigen::Index its = block + pair;
      of_their_blocks.set(
          static_cast<std::size_t>(pair),
          blocks.frame.phases[0].data()[its] + static_cast<float>(of_blocks.count.data()[its]),
          blocks.sigma.cycles[0].data()[its],
          frame.has_amplitude() ? blocks.frame.amplitudes[0].data()[its] : 1.0F,
          of_blocks.certain.data()[its] != 0);
    }
    count.fill(none);
    find_counts(pixels, of_pixels, of_their_blocks, scale, last_count, count.data());
    if (std::ranges::all_of(count, [](float n) { return n == none; })) return;
    likelihoods.go_to(at, pixels);
    likelihoods.find(count, likelihood);
    for (int i = 0; i < pixels; ++i) {
      const auto here = static_cast<std::size_t>(i);
      if (count[here] == none) continue;
      const float share = likelihood[here] / own.likelihood.data()[at + i];
      if (share * share * (share * share) < contradicted) continue;
      own.count.data()[at + i] = static_cast<std::uint8_t>(count[here]);
      own.certain.data()[at + i] = 1;
      own.odds_against.data()[at + i] = of_blocks.odds_against.data()[block + i / 2];
    }
  };
  for (Eigen::Index row = 0; row < frame.rows(); ++row) {
    for (Eigen::Index col = 0; col < frame.cols(); col += most_pixels) {
      match(row, col, static_cast<int>(std::min(most_pixels, frame.cols() - col)));
    }
  }
}

}  // namespace tofmap
