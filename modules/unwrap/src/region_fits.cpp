// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "region_fits.hpp"

#include "fast_math.hpp"
#include "vector_clones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// Adds the costs `other` of counts in a row to `costs`, where the count of the other region is the
/// one plus `offset`; any count beyond costs `beyond`. `other` has room for as many numbers before
/// and after it, which are read and dropped: whole vectors are loaded wherever they begin. Returns
/// the least sum.
TOFMAP_VECTOR_CLONES float add_shifted(const float* other, float beyond, int offset, int size,
                                       float* costs) {
  constexpr int lanes = DiagonalLayout::lanes;
  const int shift = std::clamp(offset, -size, size);
  const float* shifted = other + shift;
  std::array<float, lanes> least;
  least.fill(std::numeric_limits<float>::infinity());
  for (int n = 0; n < size; n += lanes) {
#pragma GCC ivdep
    for (int k = 0; k < lanes; ++k) {
      const float added = shifted[n + k];
      const auto place = static_cast<unsigned>(n + k + shift);
      const float sum = costs[n + k] + (place < static_cast<unsigned>(size) ? added : beyond);
      float& lane = least[static_cast<std::size_t>(k)];
      lane = sum < lane ? sum : lane;
      costs[n + k] = sum;
    }
  }
  return least_of(least);
}

/// ln(P / (1 − P)), never negative; certainties round to 1 in float, so it is bounded at 1 − 1e-6.
float log_odds(float certainty) {
  return std::max(std::log(certainty / std::max(1 - certainty, 1e-6F)), 0.0F);
}

}  // namespace

RegionFits::RegionFits(const BeatCost& beat, const ImageU8& nearest, OffsetUnion& forest)
    : beat_(beat),
      forest_(forest),
      size_(static_cast<int>(beat.size())),
      regions_(static_cast<std::size_t>(nearest.size())),
      next_(regions_.size(), none),
      sums_(2 * beat.size()),
      both_(beat.size()) {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const auto pixel = static_cast<int>(i);
    const int best = nearest.data()[i];
    if (best != invalid_wrap_count) regions_[i] = {best, pixel, pixel};
  }
}

bool RegionFits::join(int root, int other, int offset, float certainty, double objection_share) {
  Region& into = region(root);
  Region& from = region(other);
  const bool agree = into.best + offset == from.best;
  if (!agree || from.slot != none) {
    sum_up(root);
    sum_up(other);
    std::copy_n(slot(into.slot), size_, both_.data());
    const float least = add_shifted(slot(from.slot), bound(other), offset, size_, both_.data());
    const float apart = slot(into.slot)[into.best + 1] + slot(from.slot)[from.best + 1];
    const auto tolerated = static_cast<float>(objection_share) * log_odds(certainty);
    if (!agree && least - apart > tolerated) return false;
    std::copy(both_.begin(), both_.end(), slot(into.slot));
    free_slots_.push_back(std::exchange(from.slot, none));
    if (!agree) {
      const auto best = std::find(both_.begin(), both_.end(), least);
      into.best = static_cast<int>(best - both_.begin()) - 1;
    }
  }
  hand_over(from, into);
  return true;
}

float* RegionFits::slot(int number) {
  return &sums_[static_cast<std::size_t>(number + 1) * static_cast<std::size_t>(size_)];
}

int RegionFits::new_slot() {
  int number = 0;
  if (free_slots_.empty()) {
    number = static_cast<int>(sums_.size() / static_cast<std::size_t>(size_)) - 2;
    sums_.resize(sums_.size() + static_cast<std::size_t>(size_));
  } else {
    number = free_slots_.back();
    free_slots_.pop_back();
  }
  std::fill_n(slot(number), size_, 0.0F);
  return number;
}

/// What any count costs that is out of the limits for all pixels of a region.
float RegionFits::bound(int root) const {
  return BeatCost::bound * static_cast<float>(forest_.size(root));
}

/// Sums the costs of all pixels of a region.
void RegionFits::sum_up(int root) {
  Region& of = region(root);
  if (of.slot == none) of.slot = new_slot();
  const std::span<float> sums(slot(of.slot), beat_.size());
  for (int pixel = of.first; pixel != none; pixel = next_[static_cast<std::size_t>(pixel)]) {
    beat_.add(pixel, forest_.find(pixel).offset, sums);
  }
  of.first = of.last = none;
}

/// Gives the pixels that are not summed yet to another region.
void RegionFits::hand_over(Region& from, Region& into) {
  if (from.first == none) return;
  if (into.first == none) {
    into.first = from.first;
  } else {
    next_[static_cast<std::size_t>(into.last)] = from.first;
  }
  into.last = from.last;
  from.first = from.last = none;
}

}  // namespace tofmap
