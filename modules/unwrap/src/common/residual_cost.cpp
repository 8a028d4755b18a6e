// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/common/residual_cost.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// How a wrap count changes the residual, and where it is within the limits.
struct CountStep {
  float shift;     ///< change of the residual, cycles of B, −1/2 … 1/2
  float farthest;  ///< farthest_phase_cycles()
};

CountStep count_step(const PairLimits& limits, int n) {
  const double ratio = limits.wavelength_ratio();
  return {static_cast<float>(residual_shift_cycles(ratio, n)), farthest_phase_cycles(limits, n)};
}

/// Pixels processed at a time: few enough for their intermediate results to stay in the first-level
/// cache.
constexpr int block_pixels = 1024;

/// The smallest absolute residual of each pixel so far, in cycles of B, and its wrap count.
struct Nearest {
  std::array<float, block_pixels> cycles;
  std::array<float, block_pixels> count;
};

/// Updates `nearest` with the residuals for one wrap count.

TOFMAP_VECTOR_CLONES void take_nearer(int pixels, const float* phase_a, const float* phase_b,
                                      float wavelength_ratio, const CountStep& step, float count,
                                      Nearest& nearest) {
  float* least = nearest.cycles.data();
  float* best = nearest.count.data();
  const float shift = step.shift;
  const float farthest = step.farthest;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float difference = phase_a[i] * wavelength_ratio - phase_b[i] + shift;
    const float residual = to_half_cycle(difference == difference ? difference : 0.0F);
    const float size = residual < 0 ? -residual : residual;
    const bool is_nearer = phase_a[i] <= farthest && size < least[i];
    replace_if(is_nearer, size, least[i]);
    replace_if(is_nearer, count, best[i]);
  }
}

/// Half the squared residual over its variance, bounded. `precision` is 1 / 2σ².
[[gnu::always_inline]] inline float cost_of(float residual_cycles, float precision,
                                            bool is_within) {
  const float residual = to_half_cycle(residual_cycles);
  const float cost = residual * residual * precision;
  return is_within && cost < ResidualCost::bound ? cost : ResidualCost::bound;
}

/// The measurements of successive pixels.
struct Pixels {
  const float* phase_a;
  const float* phase_b;
  const float* sigma_a;  ///< noise of phase_a, cycles
  const float* sigma_b;
};

/// Computes the residual for wrap count 0 and its precision 1 / 2σ², in cycles of B. Pixels without
/// a return get a phase beyond all limits, so that every wrap count has the largest cost.
TOFMAP_VECTOR_CLONES void fill_residual(int pixels, const Pixels& from_, float wavelength_ratio,
                                        float residual_variance, float* phase_a,
                                        float* residual_cycles, float* precision) {
  constexpr float beyond_any_limit = 1e9F;
  const Pixels from = from_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float residual = from.phase_a[i] * wavelength_ratio - from.phase_b[i];
    const float sigma_a = from.sigma_a[i] * wavelength_ratio;
    const float variance =
        sigma_a * sigma_a + from.sigma_b[i] * from.sigma_b[i] + residual_variance;
    const bool is_present = residual == residual;
    phase_a[i] = is_present ? from.phase_a[i] : beyond_any_limit;
    residual_cycles[i] = is_present ? residual : 0.0F;
    precision[i] = is_present ? 0.5F / variance : 0.0F;
  }
}

/// Successive wrap counts, one in each SIMD lane.
constexpr int count_lanes = DiagonalLayout::lanes;

/// The tables of a ResidualCost over pixels and over wrap counts.
struct CostTables {
  const float* phase_a;
  const float* residual_cycles;
  const float* precision;
  const float* shift;  ///< begins at wrap count −1; the table extends to both sides
  const float* farthest;
};

/// Adds the costs of `size` wrap counts of some pixels to `sums`. Offsets must lie within the
/// tables.
TOFMAP_VECTOR_CLONES void add_costs(const CostTables& tables_, const CountedPixel* pixels,
                                    int pixel_count, int size, float* sums) {
  const CostTables tables = tables_;
  for (int n = 0; n < size; n += count_lanes) {
    std::array<float, count_lanes> lanes;
    for (int k = 0; k < count_lanes; ++k) lanes[static_cast<std::size_t>(k)] = sums[n + k];
    for (int i = 0; i < pixel_count; ++i) {
      const int pixel = pixels[i].pixel;
      const float phase_a = tables.phase_a[pixel];
      const float residual_cycles = tables.residual_cycles[pixel];
      const float precision = tables.precision[pixel];
      const float* shift = tables.shift + n + pixels[i].offset;
      const float* farthest = tables.farthest + n + pixels[i].offset;
#pragma GCC ivdep
      for (int k = 0; k < count_lanes; ++k) {
        float& lane = lanes[static_cast<std::size_t>(k)];
        const float sum =
            lane + cost_of(residual_cycles + shift[k], precision, phase_a <= farthest[k]);
        lane = sum;
      }
    }
    for (int k = 0; k < count_lanes; ++k) sums[n + k] = lanes[static_cast<std::size_t>(k)];
  }
}

/// Adds the likelihood of one wrap count of each pixel to `sums`. Where it is the wrap count that
/// is asked for, stores the likelihood in `own`.
TOFMAP_VECTOR_CLONES void add_likelihoods(int pixels, const float* phase_a,
                                          const float* residual_cycles, const float* precision,
                                          const CountStep& step, float count,
                                          const std::uint8_t* asked, float* sums, float* own) {
  const float shift = step.shift;
  const float farthest = step.farthest;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float likelihood =
        exp_of_negative(-cost_of(residual_cycles[i] + shift, precision[i], phase_a[i] <= farthest));
    sums[i] += likelihood;
    own[i] = static_cast<float>(asked[i]) == count ? likelihood : own[i];
  }
}

}  // namespace

float count_residual_m(const PairLimits& limits, float phase_a, float phase_b, int n_a) {
  return static_cast<float>(frequency_residual_m(limits.wavelength_a_m, limits.wavelength_b_m,
                                                 double{phase_a} + n_a, phase_b));
}

float farthest_phase_cycles(const PairLimits& limits, int n_a) {
  if (n_a == 0) return 1;
  if (n_a < 0 || n_a >= limits.count_a) return -1;
  return static_cast<float>(limits.max_range_m / limits.wavelength_a_m + noise_tolerance_cycles -
                            n_a);
}

double residual_step_m(const PairLimits& limits) {
  return residual_step_m(limits.wavelength_a_m, limits.wavelength_b_m, limits.count_a);
}

bool count_within_limits(const PairLimits& limits, float phase_a, int n_a) {
  if (n_a == 0) return true;
  const double range_m = (phase_a + n_a) * limits.wavelength_a_m;
  return n_a < limits.count_a &&
         range_m <= limits.max_range_m + noise_tolerance_cycles * limits.wavelength_a_m;
}

ImageU8 nearest_pair_counts(const Frame& frame, const PairLimits& limits) {
  ImageU8 counts(frame.phases[0].rows(), frame.phases[0].cols());
  const auto ratio = static_cast<float>(limits.wavelength_a_m / limits.wavelength_b_m);
  Nearest nearest;
  for (Eigen::Index done = 0; done < counts.size(); done += block_pixels) {
    const auto pixels =
        static_cast<int>(std::min<Eigen::Index>(block_pixels, counts.size() - done));
    nearest.cycles.fill(1);
    nearest.count.fill(0);
    const float* phase_a = frame.phases[0].data() + done;
    const float* phase_b = frame.phases[1].data() + done;
    for (int n = 0; n < limits.count_a; ++n) {
      take_nearer(pixels, phase_a, phase_b, ratio, count_step(limits, n), static_cast<float>(n),
                  nearest);
    }
    for (int i = 0; i < pixels; ++i) {
      const bool has_return = !std::isnan(phase_a[i]) && !std::isnan(phase_b[i]);
      counts.data()[done + i] =
          has_return ? static_cast<std::uint8_t>(nearest.count[static_cast<std::size_t>(i)])
                     : invalid_wrap_count;
    }
  }
  return counts;
}

ImageF reconstruct_cycles(const ImageF& phase_a, const ImageU8& counts) {
  return (counts == invalid_wrap_count).select(nan, phase_a + counts.cast<float>());
}

ResidualCost::ResidualCost(const Frame& frame, const PairLimits& limits, const PhaseSigma& sigma,
                           double residual_sigma_m)
    : count_a_(limits.count_a),
      size_(static_cast<std::size_t>(DiagonalLayout::whole_vectors(count_a_ + 2))) {
  for (ImageF* plane : {&phase_a_, &residual_cycles_, &precision_}) {
    plane->resize(frame.phases[0].rows(), frame.phases[0].cols());
  }
  const double residual_cycles = residual_sigma_m / limits.wavelength_b_m;
  fill_residual(static_cast<int>(phase_a_.size()),
                {frame.phases[0].data(), frame.phases[1].data(), sigma.cycles[0].data(),
                 sigma.cycles[1].data()},
                static_cast<float>(limits.wavelength_a_m / limits.wavelength_b_m),
                static_cast<float>(residual_cycles * residual_cycles), phase_a_.data(),
                residual_cycles_.data(), precision_.data());
  const int reach = static_cast<int>(size_);
  for (int n = -1 - reach; n < 2 * reach - 1; ++n) {
    const CountStep step = count_step(limits, n);
    shift_.push_back(step.shift);
    farthest_.push_back(step.farthest);
  }
}

float ResidualCost::operator()(Eigen::Index pixel, int n_a) const {
  if (n_a < 0 || n_a >= count_a_) return bound;
  const std::size_t at = size_ + 1 + static_cast<std::size_t>(n_a);
  return cost_of(residual_cycles_.data()[pixel] + shift_[at], precision_.data()[pixel],
                 phase_a_.data()[pixel] <= farthest_[at]);
}

void ResidualCost::add(std::span<const CountedPixel> pixels, std::span<float> costs) const {
  const CostTables tables{phase_a_.data(), residual_cycles_.data(), precision_.data(),
                          &shift_[size_], &farthest_[size_]};
  add_costs(tables, pixels.data(), static_cast<int>(pixels.size()), static_cast<int>(size_),
            costs.data());
}

ImageF ResidualCost::probability(const ImageU8& counts) const {
  ImageF probability(counts.rows(), counts.cols());
  std::array<float, block_pixels> sums;
  std::array<float, block_pixels> own;
  for (Eigen::Index done = 0; done < counts.size(); done += block_pixels) {
    const auto pixels =
        static_cast<int>(std::min<Eigen::Index>(block_pixels, counts.size() - done));
    sums.fill(0);
    own.fill(0);
    for (int n = 0; n < count_a_; ++n) {
      const std::size_t at = size_ + 1 + static_cast<std::size_t>(n);
      add_likelihoods(pixels, phase_a_.data() + done, residual_cycles_.data() + done,
                      precision_.data() + done, {shift_[at], farthest_[at]}, static_cast<float>(n),
                      counts.data() + done, sums.data(), own.data());
    }
    std::transform(own.begin(), own.begin() + pixels, sums.begin(), probability.data() + done,
                   std::divides());
  }
  return probability;
}

}  // namespace tofmap
