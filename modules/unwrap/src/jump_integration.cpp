// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_integration.hpp"

#include "offset_union.hpp"
#include "vector_clones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tofmap {
namespace {

/// Bridges are sorted by rank in so many steps, which is linear in time and finer than ranks are
/// meant.
constexpr int rank_steps = 4096;

/// Nodes of an image, decided: configurations, marginals and ranks of the most likely ones.
struct Decisions {
  std::vector<std::int32_t> step;  ///< n(q) − n(p)
  std::vector<float> certainty;    ///< marginal of the decided configuration
  std::vector<std::int32_t> rank;  ///< certainty times the node's own evidence, the highest at 0;
                                   ///< rank_steps where the node is absent

  explicit Decisions(Eigen::Index nodes)
      : step(static_cast<std::size_t>(nodes)), certainty(step.size()), rank(step.size()) {}
};

/// The planes of three configurations.
struct Configurations {
  const float* minus;
  const float* none;
  const float* plus;

  explicit Configurations(const std::array<ImageF, 3>& planes)
      : minus(planes[0].data()), none(planes[1].data()), plus(planes[2].data()) {}
};

TOFMAP_VECTOR_CLONES void decide(int nodes, const Configurations& marginal_,
                                 const Configurations& evidence_, std::int32_t* step,
                                 float* certainty, std::int32_t* rank) {
  const Configurations marginal = marginal_;
  const Configurations evidence = evidence_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const float minus = marginal.minus[i];
    const float none = marginal.none[i];
    const float plus = marginal.plus[i];
    const bool is_minus = minus >= plus;
    const float side = is_minus ? minus : plus;
    const float side_evidence = is_minus ? evidence.minus[i] : evidence.plus[i];
    const bool is_none = none >= side;
    // Configuration −1 is a count that grows.
    step[i] = is_none ? 0 : is_minus ? 1 : -1;
    certainty[i] = is_none ? none : side;
    const float support = is_none ? none * evidence.none[i] : side * side_evidence;
    const bool is_present = none == none;
    const auto below = static_cast<std::int32_t>((1 - (is_present ? support : 0)) *
                                                 static_cast<float>(rank_steps - 1));
    rank[i] = is_present ? below : rank_steps;
  }
}

Decisions decided(const std::array<ImageF, 3>& marginal, const std::array<ImageF, 3>& evidence) {
  Decisions out(marginal[0].size());
  decide(static_cast<int>(marginal[0].size()), Configurations(marginal), Configurations(evidence),
         out.step.data(), out.certainty.data(), out.rank.data());
  return out;
}

/// A jump node between the pixels p and q, numbered row by row.
struct Bridge {
  int p;
  int q;
  int step;         ///< n(q) − n(p)
  float certainty;  ///< of the step
};

/// All bridges from the highest rank to the lowest; equals stay in image order.
std::vector<Bridge> sorted_bridges(const JumpProbabilities& marginals,
                                   const JumpProbabilities& evidence, int image_cols) {
  const Decisions x = decided(marginals.x, evidence.x);
  const Decisions y = decided(marginals.y, evidence.y);
  std::vector<int> first(rank_steps + 2, 0);
  for (const Decisions* nodes : {&x, &y}) {
    for (const std::int32_t rank : nodes->rank) ++first[static_cast<std::size_t>(rank) + 1];
  }
  for (std::size_t s = 1; s < first.size(); ++s) first[s] += first[s - 1];
  std::vector<Bridge> sorted(static_cast<std::size_t>(first[rank_steps]));
  const auto append = [&](const Decisions& nodes, int nodes_a_row, int q_from_p) {
    std::size_t i = 0;
    for (int row = 0; i < nodes.rank.size(); row += image_cols) {
      for (int p = row; p < row + nodes_a_row; ++p, ++i) {
        const auto rank = static_cast<std::size_t>(nodes.rank[i]);
        if (rank == rank_steps) continue;
        sorted[static_cast<std::size_t>(first[rank]++)] = {p, p + q_from_p, nodes.step[i],
                                                           nodes.certainty[i]};
      }
    }
  };
  append(x, image_cols - 1, 1);
  append(y, image_cols, image_cols);
  return sorted;
}

/// Reads the forest back into images: regions are numbered in image order.
RelativeCounts read_forest(OffsetUnion& forest, const ImageU8& valid) {
  RelativeCounts out;
  out.count = Image<int>::Zero(valid.rows(), valid.cols());
  out.region = Image<int>::Constant(valid.rows(), valid.cols(), RelativeCounts::no_region);
  std::vector<int> number(static_cast<std::size_t>(valid.size()), RelativeCounts::no_region);
  for (int pixel = 0; pixel < valid.size(); ++pixel) {
    if (!valid.data()[pixel]) continue;
    const OffsetUnion::Place place = forest.find(pixel);
    int& region = number[static_cast<std::size_t>(place.root)];
    if (region == RelativeCounts::no_region) region = out.region_count++;
    out.count.data()[pixel] = place.offset;
    out.region.data()[pixel] = region;
  }
  return out;
}

/// Costs for counts in a row, and what any count costs that is beyond them.
struct Costs {
  const float* of;
  float beyond;
};

/// Adds two regions' costs, where the count of the other root is that of the one plus `offset`.
/// Returns the least sum.
TOFMAP_VECTOR_CLONES float add_shifted(const Costs& one, const Costs& other, int offset, int size,
                                       float* sums) {
  constexpr int lanes = 16;
  const float* other_of = other.of + offset;
  const int begin = std::clamp(-offset, 0, size);
  const int end = std::clamp(size - offset, begin, size);
  for (int n = 0; n < begin; ++n) sums[n] = one.of[n] + other.beyond;
#pragma GCC ivdep
  for (int n = begin; n < end; ++n) sums[n] = one.of[n] + other_of[n];
  for (int n = end; n < size; ++n) sums[n] = one.of[n] + other.beyond;
  std::array<float, lanes> least;
  least.fill(std::numeric_limits<float>::infinity());
  for (int n = 0; n < size; n += lanes) {
    for (int k = 0; k < lanes; ++k) {
      float& lane = least[static_cast<std::size_t>(k)];
      lane = sums[n + k] < lane ? sums[n + k] : lane;
    }
  }
  return *std::min_element(least.begin(), least.end());
}

/// The costs of the beat of regions, for every count of their roots as BeatCost::of has them for a
/// pixel. A region is named by its root.
class RegionCosts {
 public:
  explicit RegionCosts(const BeatCost& beat, Eigen::Index pixels)
      : beat_(beat), regions_(static_cast<std::size_t>(pixels)), sum_(stride()) {}

  /// What it costs both regions to be one, beyond what they cost apart: never negative but for
  /// rounding.
  float objection(int one, int other, int offset) {
    sum_least_ = add_shifted(costs(one), costs(other), offset, beat_.stride(), sum_.data());
    return sum_least_ - least(one) - least(other);
  }

  /// Makes the region `other` part of `one`, after objection() was asked for the same two.
  void join(int one, int other) {
    Region& into = regions_[static_cast<std::size_t>(one)];
    Region& from = regions_[static_cast<std::size_t>(other)];
    if (into.slot == no_slot) std::swap(into.slot, from.slot);
    if (into.slot == no_slot) into.slot = new_slot();
    if (from.slot != no_slot) free_slots_.push_back(std::exchange(from.slot, no_slot));
    into.pixels += from.pixels;
    into.least = sum_least_;
    std::copy(sum_.begin(), sum_.end(), slot(into.slot));
  }

 private:
  static constexpr int no_slot = -1;

  struct Region {
    int slot = no_slot;  ///< of its costs; a single pixel needs none
    int pixels = 1;
    float least = -1;  ///< cost of the best count; negative: not asked yet
  };

  std::size_t stride() const { return static_cast<std::size_t>(beat_.stride()); }

  float* slot(int number) { return &slots_[static_cast<std::size_t>(number) * stride()]; }

  int new_slot() {
    if (!free_slots_.empty()) {
      const int last = free_slots_.back();
      free_slots_.pop_back();
      return last;
    }
    slots_.resize(slots_.size() + stride());
    return static_cast<int>(slots_.size() / stride()) - 1;
  }

  Costs costs(int region) {
    const Region& of = regions_[static_cast<std::size_t>(region)];
    return {of.slot == no_slot ? beat_.of(region) : slot(of.slot),
            BeatCost::bound * static_cast<float>(of.pixels)};
  }

  float least(int region) {
    Region& of = regions_[static_cast<std::size_t>(region)];
    if (of.least < 0) {
      of.least = *std::min_element(beat_.of(region), beat_.of(region) + beat_.stride());
    }
    return of.least;
  }

  const BeatCost& beat_;
  std::vector<Region> regions_;  ///< by pixel
  std::vector<float> slots_;
  std::vector<int> free_slots_;
  std::vector<float> sum_;  ///< costs of the two regions that were asked for last
  float sum_least_ = 0;
};

/// ln(P / (1 − P)), never negative; certainties round to 1 in float, so it is bounded at 1 − 1e-6.
float log_odds(float certainty) {
  return std::max(std::log(certainty / std::max(1 - certainty, 1e-6F)), 0.0F);
}

/// Grows the forest over all bridges, from the highest rank to the lowest. `may_join(p, q, offset,
/// bridge)` is asked before the tree with the root q becomes part of the larger one with the root
/// p, and may note it.
template <class MayJoin>
RelativeCounts grow_forest(const JumpProbabilities& marginals, const JumpProbabilities& evidence,
                           const ImageU8& valid, const MayJoin& may_join) {
  OffsetUnion forest(static_cast<int>(valid.size()));
  for (const Bridge& bridge : sorted_bridges(marginals, evidence, static_cast<int>(valid.cols()))) {
    const OffsetUnion::Place p = forest.find(bridge.p);
    const OffsetUnion::Place q = forest.find(bridge.q);
    if (p.root == q.root) continue;
    const int offset = p.offset + bridge.step - q.offset;
    const bool p_is_larger = forest.size(p.root) >= forest.size(q.root);
    const int root = p_is_larger ? p.root : q.root;
    const int child = p_is_larger ? q.root : p.root;
    const int child_offset = p_is_larger ? offset : -offset;
    if (may_join(root, child, child_offset, bridge)) forest.join(root, child, child_offset);
  }
  return read_forest(forest, valid);
}

}  // namespace

RelativeCounts integrate_jumps(const JumpProbabilities& marginals,
                               const JumpProbabilities& evidence, const ImageU8& valid) {
  return grow_forest(marginals, evidence, valid, [](int, int, int, const Bridge&) { return true; });
}

RelativeCounts integrate_jumps_with_beat(const JumpProbabilities& marginals,
                                         const JumpProbabilities& evidence, const ImageU8& valid,
                                         const BeatCost& beat, double objection_share) {
  RegionCosts costs(beat, valid.size());
  const auto may_join = [&](int into, int other, int offset, const Bridge& bridge) {
    const auto tolerated = static_cast<float>(objection_share) * log_odds(bridge.certainty);
    if (costs.objection(into, other, offset) > tolerated) return false;
    costs.join(into, other);
    return true;
  };
  return grow_forest(marginals, evidence, valid, may_join);
}

Anchors anchor_by_beat(const RelativeCounts& counts, const BeatCost& beat) {
  const int stride = beat.stride();
  std::vector<float> sums(static_cast<std::size_t>(counts.region_count * stride), 0.0F);
  for (Eigen::Index i = 0; i < counts.region.size(); ++i) {
    const int region = counts.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    float* sum = &sums[static_cast<std::size_t>(region * stride)];
    add_shifted({sum, 0}, {beat.of(i), BeatCost::bound}, counts.count.data()[i], stride, sum);
  }
  Anchors anchors;
  for (int region = 0; region < counts.region_count; ++region) {
    const float* sum = &sums[static_cast<std::size_t>(region * stride)];
    const float* best = std::min_element(sum, sum + stride);
    float likelihood = 0;
    for (int n = 0; n < stride; ++n) likelihood += std::exp(*best - sum[n]);
    anchors.offset.push_back(static_cast<int>(best - sum) - 1);
    anchors.certainty.push_back(1 / likelihood);
  }
  return anchors;
}

Anchors anchor_at_zero(const RelativeCounts& counts) {
  const auto regions = static_cast<std::size_t>(counts.region_count);
  std::vector<int> least(regions, std::numeric_limits<int>::max());
  for (Eigen::Index i = 0; i < counts.region.size(); ++i) {
    const int region = counts.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    int& lowest = least[static_cast<std::size_t>(region)];
    lowest = std::min(lowest, counts.count.data()[i]);
  }
  Anchors anchors;
  for (const int lowest : least) {
    anchors.offset.push_back(-lowest);
    anchors.certainty.push_back(1);
  }
  return anchors;
}

}  // namespace tofmap
