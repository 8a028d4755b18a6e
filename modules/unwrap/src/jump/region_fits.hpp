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

/// How well the wrap counts of regions fit the inter-frequency residuals of their pixels. A region
/// is identified by its root in a forest; the wrap count of the region is that of its root.
///
/// Most joins are between regions whose best wrap counts agree. Their common fit is as good as
/// their separate fits, so their lists of pixels are only concatenated. For other joins, the costs
/// of all wrap counts are summed over as many pixels as the decision requires.
class RegionFits {
 public:
  /// The initial regions are the trees of `forest`, which must be flat (OffsetUnion::flatten).
  /// `nearest` is the best wrap count of each pixel by its own residual; all pixels of a tree must
  /// agree on the wrap count of the root. Pixels with invalid_wrap_count take no part.
  RegionFits(const ResidualCost& residual, const ImageU8& nearest, OffsetUnion& forest);

  /// The wrap count of the root at which the residuals of all pixels of the region cost least.
  int best_count(int root) const { return region(root).best; }

  /// Joins the region `other`, whose wrap count is that of `root` plus `offset`, to the region
  /// `root`, unless their best common fit costs more than their separate fits by more than
  /// `objection_share` times the log odds of `certainty`, the probability of the join. Returns
  /// whether they were joined; the caller must then join the trees of the forest in the same way.
  bool join(int root, int other, int offset, float certainty, double objection_share);

 private:
  static constexpr int none = -1;
  static constexpr int all = std::numeric_limits<int>::max();

  struct Region {
    int best = 0;      ///< wrap count of the root with the smallest cost
    int first = none;  ///< first pixel in the list of those not summed yet; the best wrap count of
                       ///< each of them agrees with `best`
    int last = none;   ///< last pixel in that list
    int slot = none;   ///< slot with the summed costs of all other pixels
    int summed = 0;    ///< number of summed pixels
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
  int size_;                     ///< wrap counts per slot
  std::vector<Region> regions_;  ///< indexed by root
  std::vector<int> next_;        ///< the pixel that follows each pixel in its list
  std::vector<float> sums_;      ///< slots, padded by one slot at both ends
  std::vector<int> free_slots_;
  std::vector<float> both_;  ///< summed costs of two regions together
};

}  // namespace tofmap
