// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/count_cost.hpp"

#include "common/fast_math.hpp"

#include <cmath>
#include <numbers>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {
namespace {

using count_cost::Block;
using count_cost::Candidates;
using count_cost::Estimate;
using count_cost::Measured;

/// Added to variances, so that those of phases without any noise divide.
constexpr float no_noise_m2 = 1e-12F;

TOFMAP_VECTOR_CLONES void load(int pixels, const float* phase, const float* sigma_cycles,
                               float systematic_m, Measured& out_) {
  Measured& out = out_;
  const float systematic_m2 = systematic_m * systematic_m;
  const float wavelength_m = out.wavelength_m;
  float* to_phase = out.phase.data();
  float* to_variance = out.variance_m2.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const bool is_present = phase[i] == phase[i];
    const float sigma_m = is_present ? sigma_cycles[i] * wavelength_m : 0.0F;
    to_phase[i] = is_present ? phase[i] : 0.0F;
    to_variance[i] = sigma_m * sigma_m + systematic_m2;
  }
}

/// The cost of an outlier: how much less likely it is than a residual of zero (equation 11).
TOFMAP_VECTOR_CLONES void fill_bound(int pixels, const float* first_variance_m2,
                                     const std::uint8_t* mixed, float outlier_share,
                                     Measured& other_) {
  Measured& other = other_;
  const float odds_alone = (1 - outlier_share) / outlier_share;
  constexpr float odds_mixed = (1 - mixed_outlier_share) / mixed_outlier_share;
  const float squared_m2 = other.wavelength_m * other.wavelength_m;
  const float* variance_m2 = other.variance_m2.data();
  float* bound = other.bound.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float surface_odds = mixed[i] != 0 ? odds_mixed : odds_alone;
    const float precision = squared_m2 / (first_variance_m2[i] + variance_m2[i] + no_noise_m2);
    const float height = std::sqrt(precision * (0.5F / std::numbers::pi_v<float>));
    bound[i] = std::numbers::ln2_v<float> * log2_of(1 + surface_odds * height);
  }
}

TOFMAP_VECTOR_CLONES void start(int pixels, const Measured& first_, float farthest_cycles,
                                Estimate& estimate_) {
  const Measured& first = first_;
  Estimate& estimate = estimate_;
  constexpr float beyond_limits = 1e6F;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const auto at = static_cast<std::size_t>(i);
    estimate.change_m[at] = 0;
    estimate.variance_m2[at] = first.variance_m2[at];
    estimate.cost[at] = first.phase[at] <= farthest_cycles ? 0.0F : beyond_limits;
  }
}

/// Adds the cost of the residual of one more frequency, and fuses the estimate with it unless it is
/// an outlier. `shift_` is the change of the residual by the wrap count, in cycles.
TOFMAP_VECTOR_CLONES void add(int pixels, const Measured& first_, const Measured& other_,
                              const Block& shift_, Estimate& estimate_) {
  const Measured& first = first_;
  const Measured& other = other_;
  Estimate& estimate = estimate_;
  const float ratio = other.ratio;
  const float wavelength_m = other.wavelength_m;
  const float per_metre = 1 / wavelength_m;
  const float* shift = shift_.data();
  const float* phase = first.phase.data();
  const float* other_phase = other.phase.data();
  const float* other_m2 = other.variance_m2.data();
  const float* bound = other.bound.data();
  float* change_m = estimate.change_m.data();
  float* variance_m2 = estimate.variance_m2.data();
  float* cost = estimate.cost.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float cycles = phase[i] * ratio + shift[i] - other_phase[i] + change_m[i] * per_metre;
    const float residual_m = wavelength_m * to_half_cycle(cycles);
    const float share = 1 / (variance_m2[i] + other_m2[i] + no_noise_m2);
    const float squares = 0.5F * residual_m * residual_m * share;
    const bool is_near = squares < bound[i];
    const float gain = is_near ? variance_m2[i] * share : 0.0F;
    cost[i] += is_near ? squares : bound[i];
    change_m[i] -= gain * residual_m;
    variance_m2[i] *= 1 - gain;
  }
}

TOFMAP_VECTOR_CLONES void keep_least(int pixels, float count, const Estimate& estimate_,
                                     Candidates& out_) {
  const float* cost = estimate_.cost.data();
  float* least = out_.cost.data();
  float* least_count = out_.count.data();
  float* next = out_.next_cost.data();
  float* next_count = out_.next_count.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float now = cost[i];
    const float before = least[i];
    const float before_count = least_count[i];
    const bool is_least = now < before;
    const bool is_next = now < next[i];
    replace_if(is_next, now, next[i]);
    replace_if(is_next, count, next_count[i]);
    replace_if(is_least, before, next[i]);
    replace_if(is_least, before_count, next_count[i]);
    replace_if(is_least, now, least[i]);
    replace_if(is_least, count, least_count[i]);
  }
}

/// The change of a residual by given wrap counts, in cycles.
TOFMAP_VECTOR_CLONES void fill_shift(int pixels, const float* count, float ratio, float* shift) {
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) shift[i] = to_half_cycle(ratio * count[i]);
}

}  // namespace

CountCost::CountCost(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                     const std::vector<double>& residual_sigma_m, double outlier_share,
                     const ImageU8& mixed)
    : frame_(frame),
      limits_(limits),
      sigma_(sigma),
      residual_sigma_m_(residual_sigma_m),
      outlier_share_(static_cast<float>(outlier_share)),
      mixed_(mixed),
      order_(others_by_wavelength(limits.wavelengths_m)),
      farthest_cycles_(limits.max_range_m / limits.wavelength_m() + noise_tolerance_cycles),
      others_(order_.size()) {}

void CountCost::load_frequency(std::size_t f, const float* phase, const float* sigma_cycles,
                               Measured& out) const {
  out.wavelength_m = static_cast<float>(limits_.wavelengths_m[f]);
  out.ratio = static_cast<float>(limits_.wavelength_m() / limits_.wavelengths_m[f]);
  load(pixels_, phase, sigma_cycles, static_cast<float>(residual_sigma_m_[f]), out);
}

/// `load_measured(f, out)` loads the measurements of one frequency.
template <class Load>
void CountCost::go(int pixels, const std::uint8_t* mixed, const Load& load_measured) {
  pixels_ = pixels;
  load_measured(0, first_);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    load_measured(order_[i], others_[i]);
    fill_bound(pixels_, first_.variance_m2.data(), mixed, outlier_share_, others_[i]);
  }
}

void CountCost::go_to(Eigen::Index at, int pixels) {
  go(pixels, mixed_.data() + at, [&](std::size_t f, Measured& out) {
    load_frequency(f, frame_.phases[f].data() + at, sigma_.cycles[f].data() + at, out);
  });
}

void CountCost::go_to(std::span<const int> places) {
  std::array<std::uint8_t, count_cost::block_pixels> mixed;
  for (std::size_t i = 0; i < places.size(); ++i) mixed[i] = mixed_.data()[places[i]];
  go(static_cast<int>(places.size()), mixed.data(), [&](std::size_t f, Measured& out) {
    Block phase;
    Block sigma_cycles;
    for (std::size_t i = 0; i < places.size(); ++i) {
      phase[i] = frame_.phases[f].data()[places[i]];
      sigma_cycles[i] = sigma_.cycles[f].data()[places[i]];
    }
    load_frequency(f, phase.data(), sigma_cycles.data(), out);
  });
}

const Candidates& CountCost::find_candidates() {
  constexpr float none = 1e30F;
  candidates_.cost.fill(none);
  candidates_.next_cost.fill(none);
  candidates_.count.fill(0);
  candidates_.next_count.fill(0);
  for (int count = 0; count < limits_.count; ++count) {
    find_estimate(count);
    keep_least(pixels_, static_cast<float>(count), estimate_, candidates_);
  }
  return candidates_;
}

/// The ranges and the cost for one wrap count.
void CountCost::find_estimate(int count) {
  const double farthest = count == 0 ? 1 : farthest_cycles_ - count;
  start(pixels_, first_, static_cast<float>(farthest), estimate_);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const double ratio = limits_.wavelength_m() / limits_.wavelengths_m[order_[i]];
    shift_.fill(static_cast<float>(residual_shift_cycles(ratio, count)));
    add(pixels_, first_, others_[i], shift_, estimate_);
  }
}

const std::vector<Block>& CountCost::find_all() {
  costs_.resize(static_cast<std::size_t>(limits_.count));
  for (int count = 0; count < limits_.count; ++count) {
    find_estimate(count);
    costs_[static_cast<std::size_t>(count)] = estimate_.cost;
  }
  return costs_;
}

const Block& CountCost::find(const Block& count) {
  start(pixels_, first_, 1, estimate_);
  for (const Measured& other : others_) {
    fill_shift(pixels_, count.data(), other.ratio, shift_.data());
    add(pixels_, first_, other, shift_, estimate_);
  }
  return estimate_.cost;
}

}  // namespace tofmap
