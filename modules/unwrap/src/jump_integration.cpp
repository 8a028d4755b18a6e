// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_integration.hpp"

#include "offset_union.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofmap {
namespace {

/// A jump node between the pixels p and q (numbered row by row), decided.
struct Bridge {
  int p;
  int q;
  int step;         ///< n(q) − n(p)
  float certainty;  ///< marginal of the decided configuration
  float rank;       ///< certainty times the node's own evidence for that configuration
};

void append_bridges(const std::array<ImageF, 3>& marginal, const std::array<ImageF, 3>& evidence,
                    int image_cols, int q_from_p, std::vector<Bridge>& bridges) {
  for (Eigen::Index v = 0; v < marginal[0].rows(); ++v) {
    for (Eigen::Index u = 0; u < marginal[0].cols(); ++u) {
      const float minus = marginal[0](v, u);
      const float none = marginal[1](v, u);
      const float plus = marginal[2](v, u);
      if (std::isnan(none)) continue;
      const int p = static_cast<int>(v) * image_cols + static_cast<int>(u);
      // Configuration −1 is a count that grows.
      if (none >= std::max(minus, plus)) {
        bridges.push_back({p, p + q_from_p, 0, none, none * evidence[1](v, u)});
      } else if (minus >= plus) {
        bridges.push_back({p, p + q_from_p, 1, minus, minus * evidence[0](v, u)});
      } else {
        bridges.push_back({p, p + q_from_p, -1, plus, plus * evidence[2](v, u)});
      }
    }
  }
}

/// All bridges from the highest rank to the lowest; equals stay in image order. Ranks are sorted
/// in 4096 steps, which is linear in time and finer than they are meant.
std::vector<Bridge> sorted_bridges(const JumpProbabilities& marginals,
                                   const JumpProbabilities& evidence, int image_cols) {
  std::vector<Bridge> bridges;
  bridges.reserve(static_cast<std::size_t>(marginals.x[0].size() + marginals.y[0].size()));
  append_bridges(marginals.x, evidence.x, image_cols, 1, bridges);
  append_bridges(marginals.y, evidence.y, image_cols, image_cols, bridges);

  constexpr int steps = 4096;
  const auto step_of = [](const Bridge& bridge) {
    return static_cast<std::size_t>((1 - bridge.rank) * (steps - 1));
  };
  std::vector<int> first(steps + 1, 0);
  for (const Bridge& bridge : bridges) ++first[step_of(bridge) + 1];
  for (std::size_t s = 1; s < first.size(); ++s) first[s] += first[s - 1];
  std::vector<Bridge> sorted(bridges.size());
  for (const Bridge& bridge : bridges) {
    sorted[static_cast<std::size_t>(first[step_of(bridge)]++)] = bridge;
  }
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

/// The cost of the beat of one region for every count of its root, base … base + size − 1.
struct RegionBeat {
  int base = 0;
  std::vector<float> cost;
  float bound = 0;  ///< what any other count costs: every pixel is out of its limits

  float least() const { return *std::min_element(cost.begin(), cost.end()); }
};

/// The beats of regions of one pixel each; empty where there is no return.
std::vector<RegionBeat> pixel_beats(const ImageU8& valid, const BeatCost& beat) {
  std::vector<RegionBeat> beats(static_cast<std::size_t>(valid.size()));
  for (Eigen::Index v = 0; v < valid.rows(); ++v) {
    for (Eigen::Index u = 0; u < valid.cols(); ++u) {
      if (!valid(v, u)) continue;
      RegionBeat& own = beats[static_cast<std::size_t>(v * valid.cols() + u)];
      own.bound = BeatCost::bound;
      own.cost.resize(static_cast<std::size_t>(beat.count_a()));
      for (int n = 0; n < beat.count_a(); ++n)
        own.cost[static_cast<std::size_t>(n)] = beat(v, u, n);
    }
  }
  return beats;
}

/// Adds the beats of a region whose root's count is that of `into` plus `offset`.
RegionBeat joined(const RegionBeat& into, const RegionBeat& other, int offset) {
  const int into_end = into.base + static_cast<int>(into.cost.size());
  const int other_base = other.base - offset;
  const int other_end = other_base + static_cast<int>(other.cost.size());
  RegionBeat sum;
  sum.bound = into.bound + other.bound;
  sum.base = std::min(into.base, other_base);
  const int end = std::max(into_end, other_end);
  sum.cost.reserve(static_cast<std::size_t>(end - sum.base));
  for (int n = sum.base; n < end; ++n) {
    const float a = n >= into.base && n < into_end
                        ? into.cost[static_cast<std::size_t>(n - into.base)]
                        : into.bound;
    const float b = n >= other_base && n < other_end
                        ? other.cost[static_cast<std::size_t>(n - other_base)]
                        : other.bound;
    sum.cost.push_back(a + b);
  }
  return sum;
}

/// Adds a pixel whose count is that of the region's root plus `count`.
template <class Cost>
void add_pixel(RegionBeat& region, int count, const Cost& cost, int count_a) {
  RegionBeat pixel;
  pixel.bound = BeatCost::bound;
  for (int n = 0; n < count_a; ++n) pixel.cost.push_back(cost(n));
  region = region.cost.empty()
               ? joined(RegionBeat{-count, std::vector<float>(pixel.cost.size()), 0}, pixel, count)
               : joined(region, pixel, count);
}

/// ln(P / (1 − P)), never negative; certainties round to 1 in float, so it is bounded at 1 − 1e-6.
float log_odds(float certainty) {
  return std::max(std::log(certainty / std::max(1 - certainty, 1e-6F)), 0.0F);
}

/// Grows the forest over all bridges, from the highest rank to the lowest. `may_join(p, q, offset,
/// bridge)` is asked before two trees with the roots p and q become one, and may note it.
template <class MayJoin>
RelativeCounts grow_forest(const JumpProbabilities& marginals, const JumpProbabilities& evidence,
                           const ImageU8& valid, const MayJoin& may_join) {
  OffsetUnion forest(static_cast<int>(valid.size()));
  for (const Bridge& bridge : sorted_bridges(marginals, evidence, static_cast<int>(valid.cols()))) {
    const OffsetUnion::Place p = forest.find(bridge.p);
    const OffsetUnion::Place q = forest.find(bridge.q);
    const int offset = p.offset + bridge.step - q.offset;
    if (p.root != q.root && may_join(p.root, q.root, offset, bridge)) {
      forest.join(p.root, q.root, offset);
    }
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
  std::vector<RegionBeat> beats = pixel_beats(valid, beat);
  const auto may_join = [&](int p, int q, int offset, const Bridge& bridge) {
    RegionBeat& into = beats[static_cast<std::size_t>(p)];
    RegionBeat& other = beats[static_cast<std::size_t>(q)];
    RegionBeat both = joined(into, other, offset);
    const float objection = both.least() - into.least() - other.least();
    if (objection > objection_share * log_odds(bridge.certainty)) return false;
    into = std::move(both);
    other = {};
    return true;
  };
  return grow_forest(marginals, evidence, valid, may_join);
}

Anchors anchor_by_beat(const RelativeCounts& counts, const BeatCost& beat) {
  std::vector<RegionBeat> regions(static_cast<std::size_t>(counts.region_count));
  for (Eigen::Index v = 0; v < counts.region.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.region.cols(); ++u) {
      if (counts.region(v, u) == RelativeCounts::no_region) continue;
      add_pixel(
          regions[static_cast<std::size_t>(counts.region(v, u))], counts.count(v, u),
          [&](int n) { return beat(v, u, n); }, beat.count_a());
    }
  }
  Anchors anchors;
  for (const RegionBeat& region : regions) {
    const auto best = std::min_element(region.cost.begin(), region.cost.end());
    float sum = 0;
    for (const float cost : region.cost) sum += std::exp(*best - cost);
    anchors.offset.push_back(region.base + static_cast<int>(best - region.cost.begin()));
    anchors.certainty.push_back(1 / sum);
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
