// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "jump/offset_union.hpp"

#include <cstddef>
#include <limits>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// How well regions fit the residual. A region is named by its root in a forest, and its count is
/// the root's.
///
/// Most joins are between regions whose best counts agree; then both fit together as well as apart,
/// and their pixels need only be remembered. Where they do not, costs of all counts are summed, of
/// as many pixels as decide the matter.
class RegionFits {
 public:
  /// The regions are the trees of a flat forest. `nearest` is the best count of each pixel, and all
  /// pixels of a tree make the same one best for the root. Invalid ones take no part.
  RegionFits(const ResidualCost& residual, const ImageU8& nearest, OffsetUnion& forest);

  /// The count of the root at which the beats of all pixels together cost least.
  int best_count(int root) const { return region(root).best; }

  /// Makes `other`, whose count is that of `root` plus `offset`, part of the region of `root`, for
  /// the forest to join them afterwards: unless both cost more together than apart by more than
  /// `objection_share` of the log odds of the certainty that speaks for it. Returns if it did.
  bool join(int root, int other, int offset, float certainty, double objection_share);

 private:
  static constexpr int none = -1;
  static constexpr int all = std::numeric_limits<int>::max();

  struct Region {
    int best = 0;      ///< count of the root that costs least
    int first = none;  ///< pixels that are not summed yet, as a list; the best count of each of
                       ///< them makes the root's `best`
    int last = none;
    int slot = none;  ///< of the summed costs of all others
    int summed = 0;   ///< how many those are
  };

  Region& region(int root) { return regions_[static_cast<std::size_t>(root)]; }
  const Region& region(int root) const { return regions_[static_cast<std::size_t>(root)]; }
  float* slot(int number);
  int new_slot();
  void sum_up(Region& of, int pixels);
  float add_contested(Region& into, const Region& from, int offset);
  float add_sums(const Region& into, const Region& from, int offset);
  void take_sums(Region& into, Region& from);
  void hand_over(Region& from, Region& into);

  const ResidualCost& residual_;
  OffsetUnion& forest_;
  int size_;                     ///< counts of a slot
  std::vector<Region> regions_;  ///< by root
  std::vector<int> next_;        ///< of every pixel in its list
  std::vector<float> sums_;      ///< slots, and the room of one before the first and after the last
  std::vector<int> free_slots_;
  std::vector<float> both_;
};

}  // namespace tofmap
