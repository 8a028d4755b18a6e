// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_estimate.hpp"

#include "joint/block_counts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Phase noise above which neighbouring pixels alone do not tell in which direction a phase wraps.
constexpr float loud_cycles = 0.08F;

/// A coarser pyramid level is worth its time if more than this share of the pixels is that noisy.
constexpr float loud_share = 0.02F;

/// The same if more than this share of the pixels has no certain wrap count: finding them costs as
/// much as a coarser level.
constexpr float open_share = 0.1F;

/// The wrap count that brings a pixel with this phase nearest to the range `block_cycles` of its
/// block.
std::uint8_t nearest_count(float block_cycles, float phase, int counts) {
  return static_cast<std::uint8_t>(
      std::clamp(static_cast<int>(std::lround(block_cycles - phase)), 0, counts - 1));
}

/// The coarse-to-fine prior of a noisy pixel: what the beliefs of its block say of its wrap counts.
struct BlockPrior {
  std::uint8_t best = 0;
  std::uint8_t runner_up = 0;
  float best_factor = 1;
  float runner_up_factor = 1;
  float others_factor = 1;
};

/// The prior of a pixel with this phase.
BlockPrior block_prior(const WrapCountBeliefs& coarse, Eigen::Index row, Eigen::Index col,
                       float block_phase, float phase, int counts) {
  // Exponent that tempers the factors: blocks and pixels see the same light, so little of the
  // block's information is new.
  constexpr float news = 0.15F;
  constexpr float least_share = 1e-3F;
  const float best = coarse.probability(row, col);
  const float runner_up = coarse.runner_up_probability(row, col);
  const float others = (1 - best - runner_up) / static_cast<float>(std::max(counts - 2, 1));
  const float least = std::max(others / best, least_share);
  const auto count = [&](std::uint8_t n) {
    return nearest_count(block_phase + static_cast<float>(n), phase, counts);
  };
  return {count(coarse.count(row, col)), count(coarse.runner_up(row, col)), 1,
          std::pow(std::max(runner_up / best, least), news), std::pow(least, news)};
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

void WrapCountEstimator::Scale::begin(const Frame& frame, const UnwrapLimits& limits,
                                      const PhaseSigma& sigma,
                                      const std::vector<double>& residual_sigma_m,
                                      const WrapCountPrior& prior) {
  // With two frequencies alone, hardly a pixel is certain by itself.
  is_sparse = frame.frequencies() > 2;
  if (!is_sparse) {
    model.assign(frame, limits, sigma, residual_sigma_m, prior);
    return;
  }
  mixed = prior.mixed_pixels && frame.has_amplitude()
              ? mixed_pixels(frame.amplitudes[0], sigma.cycles[0])
              : ImageU8::Zero(frame.rows(), frame.cols());
  own = find_own_counts(frame, limits, sigma, residual_sigma_m, prior, mixed);
}

void WrapCountEstimator::Scale::look_for_noise(const PhaseSigma& sigma) {
  const ImageF& sigma_cycles = sigma.cycles[0];
  Eigen::Index returns = 0;
  Eigen::Index open = 0;
  Eigen::Index loud = 0;
  for (Eigen::Index i = 0; i < sigma_cycles.size(); ++i) {
    const float noise = sigma_cycles.data()[i];
    if (std::isnan(noise)) continue;
    ++returns;
    if (is_sparse && own.certain.data()[i] != 0) continue;
    ++open;
    if (noise > loud_cycles) ++loud;
  }
  const auto is_more = [&](Eigen::Index pixels, float share) {
    return static_cast<float>(pixels) > share * static_cast<float>(returns);
  };
  is_loud = is_more(loud, loud_share);
  needs_coarser = is_loud || (is_sparse && is_more(open, open_share));
}

void WrapCountEstimator::Scale::build(const Frame& frame, const UnwrapLimits& limits,
                                      const PhaseSigma& sigma,
                                      const std::vector<double>& residual_sigma_m,
                                      const WrapCountPrior& prior, const Scale* coarser) {
  const WrapCountBeliefs* coarse = coarser != nullptr && is_loud ? &coarser->beliefs : nullptr;
  const Eigen::Index cols = frame.cols();
  const auto is_noisy = [&](Eigen::Index at) {
    return !std::isnan(frame.phases[0].data()[at]) && sigma.cycles[0].data()[at] >= loud_cycles;
  };
  const auto prior_at = [&](Eigen::Index at) {
    const Eigen::Index row = at / cols / 2;
    const Eigen::Index col = at % cols / 2;
    return block_prior(*coarse, row, col, coarser->blocks.frame.phases[0](row, col),
                       frame.phases[0].data()[at], limits.count);
  };
  if (is_sparse) {
    AppendWeights append;
    if (coarse != nullptr) {
      append = [&](int at, std::vector<CountWeight>& weights) {
        if (!is_noisy(at)) return;
        const BlockPrior block = prior_at(at);
        weights.push_back({block.best, block.best_factor / block.others_factor});
        if (block.runner_up == block.best) return;
        weights.push_back({block.runner_up, block.runner_up_factor / block.others_factor});
      };
    }
    uncertain.assign(frame, limits, sigma, residual_sigma_m, prior, own, mixed, append);
    return;
  }
  if (coarse == nullptr) return;
  std::vector<float> factors(static_cast<std::size_t>(limits.count));
  for (Eigen::Index at = 0; at < frame.phases[0].size(); ++at) {
    if (!is_noisy(at)) continue;
    const BlockPrior block = prior_at(at);
    std::ranges::fill(factors, block.others_factor);
    factors[block.runner_up] = block.runner_up_factor;
    factors[block.best] = block.best_factor;
    model.weigh_evidence(static_cast<int>(at / cols), static_cast<int>(at % cols), factors);
  }
}

void WrapCountEstimator::Scale::run(int iterations) {
  beliefs = is_sparse ? sparse.run(uncertain, own, iterations) : propagation.run(model, iterations);
}

WrapCountBeliefs WrapCountEstimator::estimate(const Frame& frame, const UnwrapLimits& limits,
                                              const PhaseSigma& sigma,
                                              const std::vector<double>& residual_sigma_m,
                                              const WrapCountOptions& options) {
  scales_.resize(static_cast<std::size_t>(options.scales));
  const auto frame_at = [&](std::size_t s) -> const Frame& {
    return s == 0 ? frame : scales_[s].blocks.frame;
  };
  const auto sigma_at = [&](std::size_t s) -> const PhaseSigma& {
    return s == 0 ? sigma : scales_[s].blocks.sigma;
  };
  const auto prior_at = [&](std::size_t s) {
    WrapCountPrior prior = options.prior;
    prior.slope_m *= static_cast<double>(1U << s);
    return prior;
  };
  std::size_t count = 0;
  while (true) {
    scales_[count].begin(frame_at(count), limits, sigma_at(count), residual_sigma_m,
                         prior_at(count));
    scales_[count].look_for_noise(sigma_at(count));
    ++count;
    if (count == scales_.size() || !scales_[count - 1].needs_coarser) break;
    scales_[count].blocks = halve(frame_at(count - 1), sigma_at(count - 1));
  }
  for (std::size_t s = count; s-- > 0;) {
    Scale& scale = scales_[s];
    const Scale* coarser = s + 1 < count ? &scales_[s + 1] : nullptr;
    if (coarser != nullptr && scale.is_sparse) {
      take_block_counts(frame_at(s), limits, sigma_at(s), residual_sigma_m, prior_at(s),
                        scale.mixed, coarser->blocks, coarser->own, scale.own);
    }
    // Beliefs of blocks serve only the noisy pixels of the level below.
    if (s > 0 && !scales_[s - 1].is_loud) continue;
    scale.build(frame_at(s), limits, sigma_at(s), residual_sigma_m, prior_at(s), coarser);
    scale.run(options.iterations);
  }

  WrapCountBeliefs beliefs = std::move(scales_[0].beliefs);
  for (std::size_t s = 1; s < count && scales_[s - 1].is_loud; ++s) {
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
