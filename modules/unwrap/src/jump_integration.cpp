// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_integration.hpp"

#include "offset_union.hpp"
#include "region_fits.hpp"
#include "vector_clones.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <limits>

namespace tofmap {
namespace {

/// Bridges are sorted by rank in steps, which is linear in time: by what their support lacks to
/// certainty, eight steps an octave, down to what rounding leaves of it.
constexpr int rank_shift = 20;
constexpr float least_lack = 1.0F / (1 << 24);
constexpr int least_lack_step = std::bit_cast<std::int32_t>(least_lack) >> rank_shift;
constexpr int rank_steps = (std::bit_cast<std::int32_t>(1.0F) >> rank_shift) - least_lack_step + 1;

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
    const float lack = 1 - support;
    const float counted = lack > least_lack ? lack : least_lack;
    const std::int32_t below =
        (std::bit_cast<std::int32_t>(counted) >> rank_shift) - least_lack_step;
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
  const auto append_row = [&](const Decisions& nodes, int row, int nodes_a_row, int q_from_p) {
    auto i = static_cast<std::size_t>(row * nodes_a_row);
    for (int p = row * image_cols; p < row * image_cols + nodes_a_row; ++p, ++i) {
      if (i >= nodes.rank.size()) break;
      const auto rank = static_cast<std::size_t>(nodes.rank[i]);
      if (rank == rank_steps) continue;
      sorted[static_cast<std::size_t>(first[rank]++)] = {p, p + q_from_p, nodes.step[i],
                                                         nodes.certainty[i]};
    }
  };
  for (int row = 0; row < marginals.x[0].rows(); ++row) {
    append_row(x, row, image_cols - 1, 1);
    append_row(y, row, image_cols, image_cols);
  }
  return sorted;
}

/// Reads the forest back into images: regions are numbered in image order, and anchored by
/// `anchor(root)`, the count of the root.
template <class Anchor>
RelativeCounts read_forest(OffsetUnion& forest, const ImageU8& valid, const Anchor& anchor) {
  RelativeCounts out;
  out.count = Image<int>::Zero(valid.rows(), valid.cols());
  out.region = Image<int>::Constant(valid.rows(), valid.cols(), RelativeCounts::no_region);
  std::vector<int> number(static_cast<std::size_t>(valid.size()), RelativeCounts::no_region);
  for (int pixel = 0; pixel < valid.size(); ++pixel) {
    if (!valid.data()[pixel]) continue;
    const OffsetUnion::Place place = forest.find(pixel);
    int& region = number[static_cast<std::size_t>(place.root)];
    if (region == RelativeCounts::no_region) {
      region = out.region_count++;
      out.anchor.push_back(anchor(place.root));
    }
    out.count.data()[pixel] = place.offset;
    out.region.data()[pixel] = region;
  }
  return out;
}

/// Grows the forest over all bridges, from the highest rank to the lowest. `may_join(p, q, offset,
/// bridge)` is asked before the tree with the root q becomes part of the larger one with the root
/// p, and may note it.
template <class MayJoin>
void grow_forest(const JumpProbabilities& marginals, const JumpProbabilities& evidence,
                 Eigen::Index image_cols, OffsetUnion& forest, const MayJoin& may_join) {
  for (const Bridge& bridge : sorted_bridges(marginals, evidence, static_cast<int>(image_cols))) {
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
}

/// The least count of every region at 0.
void anchor_at_zero(RelativeCounts& counts) {
  std::vector<int> least(counts.anchor.size(), std::numeric_limits<int>::max());
  for (Eigen::Index i = 0; i < counts.region.size(); ++i) {
    const int region = counts.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    int& lowest = least[static_cast<std::size_t>(region)];
    lowest = std::min(lowest, counts.count.data()[i]);
  }
  std::ranges::transform(least, counts.anchor.begin(), std::negate());
}

}  // namespace

RelativeCounts integrate_jumps(const JumpProbabilities& marginals,
                               const JumpProbabilities& evidence, const ImageU8& valid) {
  OffsetUnion forest(static_cast<int>(valid.size()));
  grow_forest(marginals, evidence, valid.cols(), forest,
              [](int, int, int, const Bridge&) { return true; });
  RelativeCounts counts = read_forest(forest, valid, [](int) { return 0; });
  anchor_at_zero(counts);
  return counts;
}

RelativeCounts integrate_jumps_with_beat(const JumpProbabilities& marginals,
                                         const JumpProbabilities& evidence, const ImageU8& valid,
                                         const BeatCost& beat, const ImageU8& nearest,
                                         double objection_share) {
  OffsetUnion forest(static_cast<int>(valid.size()));
  RegionFits fits(beat, nearest, forest);
  const auto may_join = [&](int root, int child, int offset, const Bridge& bridge) {
    return fits.join(root, child, offset, bridge.certainty, objection_share);
  };
  grow_forest(marginals, evidence, valid.cols(), forest, may_join);
  return read_forest(forest, valid, [&](int root) { return fits.best_count(root); });
}

}  // namespace tofmap
