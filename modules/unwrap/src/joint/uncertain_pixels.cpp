// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/uncertain_pixels.hpp"

#include "common/fast_math.hpp"
#include "joint/count_cost.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// Smallest product of unary factor and other weights.
constexpr float least_evidence = 1e-24F;

/// Numbers of a block of pixels, plane by plane.
struct SlotPlanes {
  std::array<count_cost::Block, UncertainPixels::slots> unary;
  std::array<count_cost::Block, UncertainPixels::slots> count;
  count_cost::Block least;  ///< smallest cost of each pixel, nats
};

/// Gives a wrap count its slot in the pixels where it costs least.
TOFMAP_VECTOR_CLONES void take_slot(const count_cost::Block& cost_, float count,
                                    count_cost::Block& slot_cost_, count_cost::Block& slot_count_) {
  const float* cost = cost_.data();
  float* slot_cost = slot_cost_.data();
  float* slot_count = slot_count_.data();
#pragma GCC ivdep
  for (int i = 0; i < count_cost::block_pixels; ++i) {
    const float now = cost[i];
    const bool is_less = now < slot_cost[i];
    replace_if(is_less, now, slot_cost[i]);
    replace_if(is_less, count, slot_count[i]);
  }
}

TOFMAP_VECTOR_CLONES void keep_least(const count_cost::Block& cost_, count_cost::Block& least_) {
  const float* cost = cost_.data();
  float* least = least_.data();
#pragma GCC ivdep
  for (int i = 0; i < count_cost::block_pixels; ++i) {
    const float now = cost[i];
    const float before = least[i];
    least[i] = now < before ? now : before;
  }
}

/// The unary factor of a wrap count that costs `cost` more than the best one.
[[gnu::always_inline]] inline float unary_factor(float cost) {
  const float factor = exp_of_negative(-evidence_exponent * cost);
  return factor > least_unary_factor ? factor : least_unary_factor;
}

/// Replaces costs by unary factors. `least` is the smallest cost of each pixel.
TOFMAP_VECTOR_CLONES void temper(const count_cost::Block& least_, count_cost::Block& cost_) {
  const float* least = least_.data();
  float* cost = cost_.data();
#pragma GCC ivdep
  for (int i = 0; i < count_cost::block_pixels; ++i) cost[i] = unary_factor(cost[i] - least[i]);
}

/// Gives wrap counts with these costs, one block for each, their slots.
void fill_slots(std::span<const count_cost::Block> costs, SlotPlanes& planes) {
  constexpr std::size_t slots = UncertainPixels::slots;
  for (std::size_t n = 0; n < costs.size(); ++n) {
    if (n < slots) {
      planes.unary[n] = costs[n];
      planes.count[n].fill(static_cast<float>(n));
    } else {
      take_slot(costs[n], static_cast<float>(n), planes.unary[n % slots], planes.count[n % slots]);
    }
  }
  const std::size_t used = std::min(slots, costs.size());
  planes.least = planes.unary[0];
  for (std::size_t s = 1; s < used; ++s) keep_least(planes.unary[s], planes.least);
  for (std::size_t s = 0; s < used; ++s) temper(planes.least, planes.unary[s]);
}

/// A wrap count that neighbours name.
struct Claim {
  int count;
  float factor;    ///< product of its weights
  float priority;  ///< product of its weights and of what uncertain neighbours say, for the slot
};

/// Multiplies what is said of the same wrap count.
void add_claims(std::span<const CountWeight> weights, bool are_certain,
                std::vector<Claim>& claims) {
  for (const auto& [count, factor] : weights) {
    auto claim = std::ranges::find(claims, count, &Claim::count);
    if (claim == claims.end()) claim = claims.insert(claim, {count, 1, 1});
    if (are_certain) claim->factor *= factor;
    claim->priority *= factor;
  }
}

/// Gives wrap counts that neighbours name their slots unless those of other wrap counts are more
/// likely. `unary(n)` is the unary factor of a wrap count.
template <class Unary>
void take_claimed_slots(std::span<const Claim> claims, const Unary& unary, float* evidence,
                        float* counts) {
  std::array<float, UncertainPixels::slots> priority;
  std::copy_n(evidence, priority.size(), priority.begin());
  for (const Claim& claim : claims) {
    const auto slot = static_cast<std::size_t>(claim.count) % UncertainPixels::slots;
    const float own = unary(claim.count);
    const bool has_slot = counts[slot] == static_cast<float>(claim.count);
    if (!has_slot && own * claim.priority <= priority[slot]) continue;
    priority[slot] = own * claim.priority;
    evidence[slot] = own * claim.factor;
    counts[slot] = static_cast<float>(claim.count);
  }
}

}  // namespace

std::size_t UncertainPixels::used_slots() const {
  return std::min(slots, static_cast<std::size_t>(counts_));
}

void UncertainPixels::list(const Frame& frame, const OwnCounts& own) {
  const ImageF& phase = frame.phases[0];
  const auto size = static_cast<int>(phase.size());
  raster_.clear();
  place_.resize(static_cast<std::size_t>(size));
  for (int at = 0; at < size; ++at) {
    int& place = place_[static_cast<std::size_t>(at)];
    place = is_certain;
    if (own.certain.data()[at] != 0) continue;
    place = no_return;
    if (std::isnan(phase.data()[at])) continue;
    place = static_cast<int>(raster_.size());
    raster_.push_back(at);
  }
}

void UncertainPixels::connect(const Frame& frame, const UnwrapLimits& limits,
                              const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m,
                              const WrapCountPrior& prior) {
  const auto padded =
      static_cast<std::size_t>(DiagonalLayout::whole_vectors(static_cast<int>(size())));
  const auto wavelength_m = static_cast<float>(limits.wavelength_m());
  const auto systematic_m2 = static_cast<float>(residual_sigma_m[0] * residual_sigma_m[0]);
  const auto load = [&](PixelArrays& arrays, std::size_t i, int at) {
    const float sigma_m = sigma.cycles[0].data()[at] * wavelength_m;
    arrays.phases[0][i] = frame.phases[0].data()[at];
    arrays.variances_m2[0][i] = sigma_m * sigma_m + systematic_m2;
    if (frame.has_amplitude()) arrays.amplitude[i] = frame.amplitudes[0].data()[at];
  };
  pixels_.assign(padded, 1, 0);
  for (std::size_t i = 0; i < size(); ++i) load(pixels_, i, raster_[i]);

  const EdgeScale scale(limits, prior);
  const auto cols = static_cast<int>(frame.cols());
  const auto end = static_cast<int>(frame.phases[0].size());
  for (const Direction direction : {left, above, right, below}) {
    const bool leads = direction == right || direction == below;
    const bool is_across = direction == left || direction == right;
    const int step = (is_across ? 1 : cols) * (leads ? 1 : -1);
    // The column that has no neighbour in this direction.
    const int end_col = leads ? cols - 1 : 0;
    std::vector<int>& neighbour = neighbour_[direction];
    neighbour.assign(size(), no_return);
    others_.assign(padded, 1, 0);
    for (std::size_t i = 0; i < size(); ++i) {
      const int at = raster_[i] + step;
      if (at < 0 || at >= end || (is_across && raster_[i] % cols == end_col)) continue;
      neighbour[i] = place_[static_cast<std::size_t>(at)];
      if (neighbour[i] != no_return) load(others_, i, at);
    }
    same_[direction].resize(padded);
    next_[direction].resize(padded);
    if (padded == 0) continue;
    const PixelsAt here{pixels_, 0};
    const PixelsAt there{others_, 0};
    fill_pairwise_factors(leads ? here : there, leads ? there : here, static_cast<int>(padded),
                          scale, same_[direction].data(), next_[direction].data());
  }
}

/// The messages of neighbours that are certain, or of those that are not, as if they were sure of
/// their own wrap counts: √ψ, with which they multiply a belief.
void UncertainPixels::append_messages(std::size_t pixel, bool of_certain, const OwnCounts& own,
                                      int cols, std::vector<CountWeight>& weights) const {
  const std::array<int, 4> steps{-1, -cols, 1, cols};
  for (const Direction direction : {left, above, right, below}) {
    const int neighbour = neighbour_[direction][pixel];
    if (neighbour == no_return || (neighbour == is_certain) != of_certain) continue;
    const int count = own.count.data()[raster_[pixel] + steps[direction]];
    const float same = same_[direction][pixel];
    const float next = next_[direction][pixel];
    const bool leads = direction == right || direction == below;
    const int other = count + ((next > 0) == leads ? -1 : 1);
    if (same > 0) weights.push_back({count, std::sqrt(1 + same)});
    if (next == 0 || other < 0 || other >= counts_) continue;
    weights.push_back({other, std::sqrt(1 + std::abs(next))});
  }
}

void UncertainPixels::assign(const Frame& frame, const UnwrapLimits& limits,
                             const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m,
                             const WrapCountPrior& prior, const OwnCounts& own,
                             const ImageU8& mixed, const AppendWeights& append_weights) {
  counts_ = limits.count;
  list(frame, own);
  connect(frame, limits, sigma, residual_sigma_m, prior);
  evidence_.assign(size() * slots, 0.0F);
  slot_counts_.assign(share_slots() ? size() * slots : 0, 0.0F);
  const auto cols = static_cast<int>(frame.cols());
  const std::size_t used = used_slots();
  CountCost costs(frame, limits, sigma, residual_sigma_m, prior.outlier_share, mixed);
  SlotPlanes planes;
  std::vector<CountWeight> weights;
  std::vector<CountWeight> guesses;
  std::vector<Claim> claims;
  constexpr std::size_t most_pixels = count_cost::block_pixels;
  for (std::size_t pixel = 0; pixel < size(); ++pixel) {
    const std::size_t i = pixel % most_pixels;
    if (i == 0) {
      costs.go_to({&raster_[pixel], std::min(most_pixels, size() - pixel)});
      fill_slots(costs.find_all(), planes);
    }
    float* evidence = &evidence_[pixel * slots];
    for (std::size_t s = 0; s < used; ++s) evidence[s] = planes.unary[s][i];
    weights.clear();
    append_messages(pixel, true, own, cols, weights);
    if (append_weights) append_weights(raster_[pixel], weights);
    if (share_slots()) {
      float* counts = &slot_counts_[pixel * slots];
      for (std::size_t s = 0; s < used; ++s) counts[s] = planes.count[s][i];
      guesses.clear();
      append_messages(pixel, false, own, cols, guesses);
      claims.clear();
      add_claims(weights, true, claims);
      add_claims(guesses, false, claims);
      const auto unary = [&](int count) {
        return unary_factor(costs.all()[static_cast<std::size_t>(count)][i] - planes.least[i]);
      };
      take_claimed_slots(claims, unary, evidence, counts);
    } else {
      for (const auto& [count, factor] : weights) evidence[count] *= factor;
    }
    const float scale = 1 / *std::max_element(evidence, evidence + used);
    for (std::size_t s = 0; s < used; ++s) {
      evidence[s] = std::max(evidence[s] * scale, least_evidence);
    }
  }
}

}  // namespace tofmap
