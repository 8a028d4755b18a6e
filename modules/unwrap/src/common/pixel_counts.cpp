// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "common/pixel_counts.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {
namespace {

/// Pixels processed at a time: few enough for their intermediate results to stay in the first-level
/// cache.
constexpr int block_pixels = 512;
using Block = std::array<float, block_pixels>;

/// The ranges of a block of pixels for one wrap count, as the frequencies so far estimate them.
struct Estimate {
  Block range_m;
  Block variance_m2;
  Block cost;     ///< of the wrap count, nats
  Block bounded;  ///< the same with the cost of each frequency bounded
};

/// The measurements of one frequency in a block of pixels.
struct Measured {
  const float* phase;
  const float* sigma_cycles;
  float wavelength_m;
};

/// The ranges of the first frequency. Wrap counts beyond the limits have the largest cost.
TOFMAP_VECTOR_CLONES void start(int pixels, const Measured& first_, float count, float max_range_m,
                                Estimate& estimate) {
  constexpr float beyond_limits = 1e6F;
  const Measured first = first_;
  const float farthest_m =
      max_range_m + static_cast<float>(noise_tolerance_cycles) * first.wavelength_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float sigma_m = first.sigma_cycles[i] * first.wavelength_m;
    const float range_m = (first.phase[i] + count) * first.wavelength_m;
    const float cost = count == 0 || range_m <= farthest_m ? 0.0F : beyond_limits;
    estimate.range_m[static_cast<std::size_t>(i)] = range_m;
    estimate.variance_m2[static_cast<std::size_t>(i)] = sigma_m * sigma_m;
    estimate.cost[static_cast<std::size_t>(i)] = cost;
    estimate.bounded[static_cast<std::size_t>(i)] = cost;
  }
}

/// Adds the cost of the residual of one more frequency, and fuses the estimate with it.
TOFMAP_VECTOR_CLONES void add(int pixels, const Measured& other_, Estimate& estimate) {
  const Measured other = other_;
  float* range_m = estimate.range_m.data();
  float* variance_m2 = estimate.variance_m2.data();
  float* cost = estimate.cost.data();
  float* bounded = estimate.bounded.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float sigma_m = other.sigma_cycles[i] * other.wavelength_m;
    const float sum_m2 = variance_m2[i] + sigma_m * sigma_m;
    const float cycles = range_m[i] / other.wavelength_m - other.phase[i];
    const float residual_m = other.wavelength_m * to_half_cycle(cycles == cycles ? cycles : 0.0F);
    const float added = 0.5F * residual_m * residual_m / sum_m2;
    const float gain = variance_m2[i] / sum_m2;
    cost[i] += added;
    bounded[i] += added < ResidualCost::bound ? added : ResidualCost::bound;
    range_m[i] -= gain * residual_m;
    variance_m2[i] *= 1 - gain;
  }
}

/// Calls `visit(first pixel, pixels, wrap count, estimate)` for every block of a frame and every
/// wrap count.
template <class Visit>
void for_each_estimate(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                       const Visit& visit) {
  const std::vector<std::size_t> others = others_by_wavelength(limits.wavelengths_m);
  const Eigen::Index size = frame.phases.front().size();
  const auto measured = [&](std::size_t f, Eigen::Index at) {
    return Measured{frame.phases[f].data() + at, sigma.cycles[f].data() + at,
                    static_cast<float>(limits.wavelengths_m[f])};
  };
  Estimate estimate;
  for (Eigen::Index at = 0; at < size; at += block_pixels) {
    const auto pixels = static_cast<int>(std::min<Eigen::Index>(block_pixels, size - at));
    for (int count = 0; count < limits.count; ++count) {
      start(pixels, measured(0, at), static_cast<float>(count),
            static_cast<float>(limits.max_range_m), estimate);
      for (const std::size_t f : others) add(pixels, measured(f, at), estimate);
      visit(at, pixels, count, estimate);
    }
  }
}

}  // namespace

ImageU8 nearest_counts(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma) {
  const ImageF& phase = frame.phases.front();
  if (limits.frequencies() == 2) return nearest_pair_counts(frame, limits.pair(0, 1));
  ImageU8 counts =
      phase.isNaN().select(invalid_wrap_count, ImageU8::Zero(phase.rows(), phase.cols()));
  if (limits.frequencies() == 1) return counts;
  Block least;
  for_each_estimate(frame, limits, sigma,
                    [&](Eigen::Index at, int pixels, int count, const Estimate& estimate) {
                      if (count == 0) least = estimate.cost;
                      for (int i = 0; i < pixels; ++i) {
                        const auto pixel = static_cast<std::size_t>(i);
                        if (!(estimate.cost[pixel] < least[pixel])) continue;
                        least[pixel] = estimate.cost[pixel];
                        counts.data()[at + i] = static_cast<std::uint8_t>(count);
                      }
                    });
  return phase.isNaN().select(invalid_wrap_count, counts);
}

ImageF count_probability(const Frame& frame, const ImageU8& counts, const UnwrapLimits& limits,
                         const PhaseSigma& sigma) {
  if (limits.frequencies() == 2) {
    return ResidualCost(frame, limits.pair(0, 1), sigma).probability(counts);
  }
  const auto is_invalid = counts == invalid_wrap_count;
  if (limits.frequencies() == 1) {
    return is_invalid.select(0.0F, ImageF::Constant(counts.rows(), counts.cols(),
                                                    1.0F / static_cast<float>(limits.count)));
  }
  ImageF own = ImageF::Zero(counts.rows(), counts.cols());
  ImageF sum = own;
  for_each_estimate(
      frame, limits, sigma, [&](Eigen::Index at, int pixels, int count, const Estimate& estimate) {
        for (int i = 0; i < pixels; ++i) {
          const float likelihood = exp_of_negative(-estimate.bounded[static_cast<std::size_t>(i)]);
          sum.data()[at + i] += likelihood;
          if (counts.data()[at + i] == count) own.data()[at + i] = likelihood;
        }
      });
  return is_invalid.select(0.0F, own / sum);
}

}  // namespace tofmap
