// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jump/region_fits.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// Adds the costs `other` of another region to `costs`, where the wrap count of the other region is
/// that of this region plus `offset`. Wrap counts outside of `other` cost `beyond`. `other` must be
/// padded by `size` numbers at both ends: whole vectors are read there, but their values are not
/// used. Returns the smallest sum.
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

/// ln(P / (1 − P)), at least 0. 1 − P is taken to be at least 1e-6, since P may round to 1 in
/// float.
float log_odds(float certainty) {
  return std::max(std::log(certainty / std::max(1 - certainty, 1e-6F)), 0.0F);
}

}  // namespace

RegionFits::RegionFits(const ResidualCost& residual, const ImageU8& nearest, OffsetUnion& forest)
    : residual_(residual),
      forest_(forest),
      size_(static_cast<int>(residual.size())),
      regions_(static_cast<std::size_t>(nearest.size())),
      next_(regions_.size(), none),
      sums_(2 * residual.size()),
      both_(residual.size()) {
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    const int best = nearest.data()[i];
    if (best == invalid_wrap_count) continue;
    const auto pixel = static_cast<int>(i);
    const int root = forest.parent(pixel);
    Region& of = region(root);
    if (pixel == root) of.best = best;
    if (of.first == none) of.last = pixel;
    next_[i] = of.first;
    of.first = pixel;
  }
}

bool RegionFits::join(int root, int other, int offset, float certainty, double objection_share) {
  Region& into = region(root);
  Region& from = region(other);
  if (into.best + offset != from.best) {
    sum_up(from, all);
    const float least = add_contested(into, from, offset);
    const float apart = slot(into.slot)[into.best + 1] + slot(from.slot)[from.best + 1];
    const auto tolerated = static_cast<float>(objection_share) * log_odds(certainty);
    if (least - apart > tolerated) return false;
    if (both_[static_cast<std::size_t>(into.best) + 1] > least) {
      into.best = static_cast<int>(std::ranges::find(both_, least) - both_.begin()) - 1;
    }
    take_sums(into, from);
  } else if (from.slot != none) {
    if (into.slot == none) into.slot = new_slot();
    add_sums(into, from, offset);
    take_sums(into, from);
  }
  hand_over(from, into);
  return true;
}

/// Computes the costs of both regions together in both_ and returns the smallest. `from` must be
/// summed completely. Of `into`, only as many pixels are summed as are needed to find the smallest
/// cost; the cost of the others at the best wrap count of `into` is left out.
float RegionFits::add_contested(Region& into, const Region& from, int offset) {
  constexpr int first_pixels = 4;
  for (int pixels = first_pixels;; pixels *= 2) {
    sum_up(into, pixels);
    const float least = add_sums(into, from, offset);
    // All pixels that are not summed agree on the best wrap count, and only increase its lead.
    const bool is_sure =
        into.first == none || both_[static_cast<std::size_t>(into.best) + 1] <= least;
    if (is_sure) return least;
  }
}

/// Adds the sums of both slots into both_ and returns the smallest.
float RegionFits::add_sums(const Region& into, const Region& from, int offset) {
  std::copy_n(slot(into.slot), size_, both_.data());
  const float beyond = ResidualCost::bound * static_cast<float>(from.summed);
  return add_shifted(slot(from.slot), beyond, offset, size_, both_.data());
}

/// Moves both_ into the slot of `into` and frees the slot of `from`.
void RegionFits::take_sums(Region& into, Region& from) {
  std::ranges::copy(both_, slot(into.slot));
  into.summed += std::exchange(from.summed, 0);
  free_slots_.push_back(std::exchange(from.slot, none));
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

/// Sums the costs of at most `pixels` further pixels of a region.
void RegionFits::sum_up(Region& of, int pixels) {
  if (of.slot == none) of.slot = new_slot();
  constexpr int batch_size = 128;
  std::array<CountedPixel, batch_size> batch;
  while (of.first != none && pixels > 0) {
    int size = 0;
    for (; of.first != none && pixels > 0 && size < batch_size; --pixels) {
      // All wrap counts outside the limits cost the same, so larger offsets make no difference.
      const int offset = std::clamp(forest_.find(of.first).offset, -size_, size_);
      batch[static_cast<std::size_t>(size++)] = {of.first, offset};
      of.first = next_[static_cast<std::size_t>(of.first)];
    }
    residual_.add({batch.data(), static_cast<std::size_t>(size)},
                  {slot(of.slot), residual_.size()});
    of.summed += size;
  }
  if (of.first == none) of.last = none;
}

/// Moves the pixels that are not summed yet from one region to another.
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
