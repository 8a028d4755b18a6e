// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_estimate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Phase noise above which neighbouring pixels alone do not tell in which direction a phase wraps.
constexpr float loud_cycles = 0.08F;

/// A coarser pyramid level is worth its time if more than this share of the pixels is that noisy.
constexpr float loud_share = 0.02F;

std::complex<float> phasor(float phase, float amplitude) {
  return std::polar(amplitude, 2 * std::numbers::pi_v<float> * phase);
}

float phase_of(std::complex<float> sum) {
  const float cycles = std::arg(sum) / (2 * std::numbers::pi_v<float>);
  return cycles < 0 ? std::min(cycles + 1, std::nextafter(1.0F, 0.0F)) : cycles;
}

bool is_loud(const PhaseSigma& sigma) {
  const auto returns = static_cast<float>((sigma.cycles[0] == sigma.cycles[0]).count());
  const auto loud = static_cast<float>((sigma.cycles[0] > loud_cycles).count());
  return loud > loud_share * returns;
}

/// The wrap count that brings a pixel with this phase nearest to the range `block_cycles` of its
/// block.
std::uint8_t nearest_count(float block_cycles, float phase, int counts) {
  return static_cast<std::uint8_t>(
      std::clamp(static_cast<int>(std::lround(block_cycles - phase)), 0, counts - 1));
}

/// Converts the beliefs of a block into the coarse-to-fine prior of one of its pixels: a factor for
/// each wrap count of the pixel.
void set_factors(const WrapCountBeliefs& coarse, Eigen::Index row, Eigen::Index col,
                 float block_phase, float phase, std::vector<float>& factors) {
  // Exponent that tempers the factors: blocks and pixels see the same light, so little of the
  // block's information is new.
  constexpr float news = 0.15F;
  constexpr float least_share = 1e-3F;
  const auto counts = static_cast<int>(factors.size());
  const float best = coarse.probability(row, col);
  const float runner_up = coarse.runner_up_probability(row, col);
  const float others = (1 - best - runner_up) / static_cast<float>(std::max(counts - 2, 1));
  const float least = std::max(others / best, least_share);
  const auto set = [&](std::uint8_t count, float share) {
    const int n = nearest_count(block_phase + static_cast<float>(count), phase, counts);
    factors[static_cast<std::size_t>(n)] = std::pow(share, news);
  };
  std::fill(factors.begin(), factors.end(), std::pow(least, news));
  set(coarse.runner_up(row, col), std::max(runner_up / best, least));
  set(coarse.count(row, col), 1);
}

/// Multiplies the unary factors of noisy pixels by the coarse-to-fine prior of their blocks, which
/// have 2 x 2 pixels.
void apply_coarse_prior(const Frame& pixels, const PhaseSigma& sigma, const Frame& blocks,
                        const WrapCountBeliefs& coarse, WrapCountModel& model) {
  std::vector<float> factors(static_cast<std::size_t>(model.counts()));
  for (Eigen::Index v = 0; v < pixels.phases[0].rows(); ++v) {
    for (Eigen::Index u = 0; u < pixels.phases[0].cols(); ++u) {
      if (std::isnan(pixels.phases[0](v, u)) || sigma.cycles[0](v, u) < loud_cycles) continue;
      set_factors(coarse, v / 2, u / 2, blocks.phases[0](v / 2, u / 2), pixels.phases[0](v, u),
                  factors);
      model.weigh_evidence(static_cast<int>(v), static_cast<int>(u), factors);
    }
  }
}

/// The probability of the coarse level's wrap count, given that the coarse level is surer than the
/// fine one. Both levels see the same light, so agreement does not raise the probability;
/// disagreement lowers it, as choosing the surer level is biased towards overconfidence.
float joint_probability(float coarse, float fine, bool agree) {
  return agree ? coarse : coarse * coarse / (coarse + fine);
}

/// Replaces the beliefs of noisy pixels by those of their blocks where the block is surer.
void take_coarse_counts(const Frame& pixels, const NoisyFrame& blocks, int block_px,
                        const WrapCountBeliefs& coarse, int counts, WrapCountBeliefs& fine) {
  for (Eigen::Index v = 0; v < pixels.phases[0].rows(); ++v) {
    for (Eigen::Index u = 0; u < pixels.phases[0].cols(); ++u) {
      const Eigen::Index row = v / block_px;
      const Eigen::Index col = u / block_px;
      const float pixel_sigma = static_cast<float>(block_px) * blocks.sigma.cycles[0](row, col);
      if (std::isnan(pixels.phases[0](v, u)) || pixel_sigma <= loud_cycles) continue;
      if (coarse.other_probability(row, col) >= fine.other_probability(v, u)) continue;
      const float phase = pixels.phases[0](v, u);
      const float block_phase = blocks.frame.phases[0](row, col);
      const auto count = [&](std::uint8_t n) {
        return nearest_count(block_phase + static_cast<float>(n), phase, counts);
      };
      const std::uint8_t coarse_count = count(coarse.count(row, col));
      const bool agree = coarse_count == fine.count(v, u);
      fine.count(v, u) = coarse_count;
      fine.probability(v, u) =
          joint_probability(coarse.probability(row, col), fine.probability(v, u), agree);
      fine.other_probability(v, u) =
          agree ? coarse.other_probability(row, col) : 1 - fine.probability(v, u);
      fine.runner_up(v, u) = count(coarse.runner_up(row, col));
      fine.runner_up_probability(v, u) = coarse.runner_up_probability(row, col);
    }
  }
}

}  // namespace

namespace {

/// The sum of the phasors of one frequency in a block, and the variance of its noise.
struct BlockSum {
  std::complex<float> phasor = 0;
  float noise_variance = 0;

  void add(float phase, float amplitude, float sigma_cycles) {
    const float noise = amplitude * sigma_cycles;
    phasor += tofmap::phasor(phase, amplitude);
    noise_variance += noise * noise;
  }

  float amplitude() const { return std::max(std::abs(phasor), 1e-6F); }
  /// Phase noise of the sum: its noise relative to its length.
  float sigma_cycles() const { return std::sqrt(noise_variance) / amplitude(); }
};

}  // namespace

NoisyFrame halve(const Frame& frame, const PhaseSigma& sigma) {
  const Eigen::Index rows = (frame.rows() + 1) / 2;
  const Eigen::Index cols = (frame.cols() + 1) / 2;
  const std::size_t frequencies = frame.frequencies();
  NoisyFrame out;
  out.frame.index = frame.index;
  out.frame.timestamp_s = frame.timestamp_s;
  out.frame.phases.assign(frequencies, ImageF::Constant(rows, cols, nan));
  out.frame.amplitudes.assign(frequencies, ImageF::Zero(rows, cols));
  out.sigma.cycles.assign(frequencies, ImageF::Constant(rows, cols, nan));
  const bool weighted = frame.has_amplitude();
  const auto is_missing = [](const ImageF& phase, Eigen::Index v, Eigen::Index u) {
    return std::isnan(phase(v, u));
  };
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (Eigen::Index col = 0; col < cols; ++col) {
      std::array<BlockSum, most_frequencies> sums;
      int count = 0;
      for (Eigen::Index v = 2 * row; v < std::min(2 * row + 2, frame.rows()); ++v) {
        for (Eigen::Index u = 2 * col; u < std::min(2 * col + 2, frame.cols()); ++u) {
          if (std::ranges::any_of(frame.phases,
                                  [&](const ImageF& phase) { return is_missing(phase, v, u); })) {
            continue;
          }
          for (std::size_t f = 0; f < frequencies; ++f) {
            sums[f].add(frame.phases[f](v, u), weighted ? frame.amplitudes[f](v, u) : 1.0F,
                        sigma.cycles[f](v, u));
          }
          ++count;
        }
      }
      if (count == 0) continue;
      for (std::size_t f = 0; f < frequencies; ++f) {
        out.frame.phases[f](row, col) = phase_of(sums[f].phasor);
        out.frame.amplitudes[f](row, col) = sums[f].amplitude() / static_cast<float>(count);
        out.sigma.cycles[f](row, col) = sums[f].sigma_cycles();
      }
    }
  }
  return out;
}

/// Builds the pyramid: blocks and noise of the levels that the noise requires, at most `most`
/// levels. Returns the number of levels.
int WrapCountEstimator::divide(const Frame& frame, const PhaseSigma& sigma, int most) {
  scales_.resize(static_cast<std::size_t>(most));
  const Frame* finer = &frame;
  const PhaseSigma* finer_sigma = &sigma;
  int count = 1;
  while (count < most && is_loud(*finer_sigma)) {
    Scale& scale = scales_[static_cast<std::size_t>(count)];
    scale.blocks = halve(*finer, *finer_sigma);
    finer = &scale.blocks.frame;
    finer_sigma = &scale.blocks.sigma;
    ++count;
  }
  return count;
}

WrapCountBeliefs WrapCountEstimator::estimate(const Frame& frame, const UnwrapLimits& limits,
                                              const PhaseSigma& sigma,
                                              const std::vector<double>& residual_sigma_m,
                                              const WrapCountOptions& options) {
  const int count = divide(frame, sigma, options.scales);
  const auto seen_at = [&](std::size_t s) -> const Frame& {
    return s == 0 ? frame : scales_[s].blocks.frame;
  };
  for (auto s = static_cast<std::size_t>(count); s-- > 0;) {
    Scale& scale = scales_[s];
    WrapCountPrior prior = options.prior;
    prior.slope_m *= static_cast<double>(1U << s);
    const PhaseSigma& its_sigma = s == 0 ? sigma : scale.blocks.sigma;
    scale.model.assign(seen_at(s), limits, its_sigma, residual_sigma_m, prior);
    if (static_cast<int>(s) + 1 < count) {
      const Scale& coarser = scales_[s + 1];
      apply_coarse_prior(seen_at(s), its_sigma, coarser.blocks.frame, coarser.beliefs, scale.model);
    }
    scale.beliefs = scale.propagation.run(scale.model, options.iterations);
  }

  WrapCountBeliefs beliefs = std::move(scales_[0].beliefs);
  for (std::size_t s = 1; s < static_cast<std::size_t>(count); ++s) {
    const Scale& coarse = scales_[s];
    take_coarse_counts(frame, coarse.blocks, 1 << s, coarse.beliefs, limits.count, beliefs);
    beliefs.iterations += coarse.beliefs.iterations;
    beliefs.largest_message_change =
        std::max(beliefs.largest_message_change, coarse.beliefs.largest_message_change);
  }
  beliefs.count = frame.phases[0].isNaN().select(invalid_wrap_count, beliefs.count);
  beliefs.probability = frame.phases[0].isNaN().select(0.0F, beliefs.probability);
  return beliefs;
}

}  // namespace tofmap
