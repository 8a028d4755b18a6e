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
  int step;  ///< n(q) − n(p)
  float certainty;
};

void append_bridges(const std::array<ImageF, 3>& marginal, int image_cols, int q_from_p,
                    std::vector<Bridge>& bridges) {
  for (Eigen::Index v = 0; v < marginal[0].rows(); ++v) {
    for (Eigen::Index u = 0; u < marginal[0].cols(); ++u) {
      const float minus = marginal[0](v, u);
      const float none = marginal[1](v, u);
      const float plus = marginal[2](v, u);
      if (std::isnan(none)) continue;
      const int p = static_cast<int>(v) * image_cols + static_cast<int>(u);
      // Configuration −1 is a count that grows.
      if (none >= std::max(minus, plus)) {
        bridges.push_back({p, p + q_from_p, 0, none});
      } else if (minus >= plus) {
        bridges.push_back({p, p + q_from_p, 1, minus});
      } else {
        bridges.push_back({p, p + q_from_p, -1, plus});
      }
    }
  }
}

/// All bridges from the most certain to the least; equals stay in image order. Certainties are
/// sorted in 4096 steps, which is linear in time and finer than they are meant.
std::vector<Bridge> sorted_bridges(const JumpProbabilities& marginals, int image_cols) {
  std::vector<Bridge> bridges;
  bridges.reserve(static_cast<std::size_t>(marginals.x[0].size() + marginals.y[0].size()));
  append_bridges(marginals.x, image_cols, 1, bridges);
  append_bridges(marginals.y, image_cols, image_cols, bridges);

  constexpr int steps = 4096;
  const auto step_of = [](const Bridge& bridge) {
    return static_cast<std::size_t>((1 - bridge.certainty) * (steps - 1));
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

  float least() const { return *std::min_element(cost.begin(), cost.end()); }
};

/// Sums the beat of all pixels of each region. Offsets that carry a pixel out of its limits
/// cost the bound; offsets are tried as long as at least one pixel can be within.
std::vector<RegionBeat> region_beats(const RelativeCounts& counts, const BeatCost& beat) {
  const auto regions = static_cast<std::size_t>(counts.region_count);
  std::vector<int> low(regions, std::numeric_limits<int>::max());
  std::vector<int> high(regions, std::numeric_limits<int>::min());
  for (Eigen::Index i = 0; i < counts.region.size(); ++i) {
    const int region = counts.region.data()[i];
    if (region == RelativeCounts::no_region) continue;
    auto& lowest = low[static_cast<std::size_t>(region)];
    auto& highest = high[static_cast<std::size_t>(region)];
    lowest = std::min(lowest, counts.count.data()[i]);
    highest = std::max(highest, counts.count.data()[i]);
  }
  std::vector<RegionBeat> beats(regions);
  for (std::size_t r = 0; r < regions; ++r) {
    beats[r].base = -high[r];
    beats[r].cost.assign(static_cast<std::size_t>(high[r] - low[r] + beat.count_a()), 0);
  }
  for (Eigen::Index v = 0; v < counts.region.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.region.cols(); ++u) {
      const int region = counts.region(v, u);
      if (region == RelativeCounts::no_region) continue;
      RegionBeat& sum = beats[static_cast<std::size_t>(region)];
      for (std::size_t o = 0; o < sum.cost.size(); ++o) {
        const int n = counts.count(v, u) + sum.base + static_cast<int>(o);
        sum.cost[o] += n < 0 ? BeatCost::bound : beat(v, u, n);
      }
    }
  }
  return beats;
}

/// Adds the beats of a region whose root's count is that of `into` plus `offset`. Where only
/// one of them was tried, the other would be wholly out of its limits.
RegionBeat joined(const RegionBeat& into, const RegionBeat& other, int offset, float into_bound,
                  float other_bound) {
  const int into_end = into.base + static_cast<int>(into.cost.size());
  const int other_base = other.base - offset;
  const int other_end = other_base + static_cast<int>(other.cost.size());
  RegionBeat sum;
  sum.base = std::min(into.base, other_base);
  const int end = std::max(into_end, other_end);
  for (int n = sum.base; n < end; ++n) {
    const float a = n >= into.base && n < into_end
                        ? into.cost[static_cast<std::size_t>(n - into.base)]
                        : into_bound;
    const float b = n >= other_base && n < other_end
                        ? other.cost[static_cast<std::size_t>(n - other_base)]
                        : other_bound;
    sum.cost.push_back(a + b);
  }
  return sum;
}

}  // namespace

RelativeCounts integrate_jumps(const JumpProbabilities& marginals, const ImageU8& valid,
                               double least_certainty) {
  OffsetUnion forest(static_cast<int>(valid.size()));
  for (const Bridge& bridge : sorted_bridges(marginals, static_cast<int>(valid.cols()))) {
    if (bridge.certainty < least_certainty) continue;
    const OffsetUnion::Place p = forest.find(bridge.p);
    const OffsetUnion::Place q = forest.find(bridge.q);
    if (p.root == q.root) continue;
    forest.join(p.root, q.root, p.offset + bridge.step - q.offset);
  }
  return read_forest(forest, valid);
}

RelativeCounts join_regions(const RelativeCounts& parts, const JumpProbabilities& marginals,
                            const BeatCost& beat, double objection_nats) {
  std::vector<RegionBeat> beats = region_beats(parts, beat);
  std::vector<float> bounds(beats.size(), 0);
  for (Eigen::Index i = 0; i < parts.region.size(); ++i) {
    const int region = parts.region.data()[i];
    if (region != RelativeCounts::no_region)
      bounds[static_cast<std::size_t>(region)] += BeatCost::bound;
  }
  OffsetUnion regions(parts.region_count);
  for (const Bridge& bridge : sorted_bridges(marginals, static_cast<int>(parts.region.cols()))) {
    const OffsetUnion::Place p = regions.find(parts.region.data()[bridge.p]);
    const OffsetUnion::Place q = regions.find(parts.region.data()[bridge.q]);
    if (p.root == q.root) continue;
    const int offset = parts.count.data()[bridge.p] + p.offset + bridge.step -
                       parts.count.data()[bridge.q] - q.offset;
    const auto a = static_cast<std::size_t>(p.root);
    const auto b = static_cast<std::size_t>(q.root);
    RegionBeat both = joined(beats[a], beats[b], offset, bounds[a], bounds[b]);
    const float objection = both.least() - beats[a].least() - beats[b].least();
    const float log_odds = std::log(bridge.certainty / std::max(1 - bridge.certainty, 1e-6F));
    if (objection > objection_nats * std::max(log_odds, 0.0F)) continue;
    regions.join(p.root, q.root, offset);
    beats[a] = std::move(both);
    bounds[a] += bounds[b];
    beats[b] = {};
  }
  RelativeCounts out = parts;
  std::vector<int> number(static_cast<std::size_t>(parts.region_count), RelativeCounts::no_region);
  out.region_count = 0;
  for (Eigen::Index i = 0; i < out.region.size(); ++i) {
    if (parts.region.data()[i] == RelativeCounts::no_region) continue;
    const OffsetUnion::Place place = regions.find(parts.region.data()[i]);
    int& region = number[static_cast<std::size_t>(place.root)];
    if (region == RelativeCounts::no_region) region = out.region_count++;
    out.count.data()[i] += place.offset;
    out.region.data()[i] = region;
  }
  return out;
}

Anchors anchor_by_beat(const RelativeCounts& counts, const BeatCost& beat) {
  Anchors anchors;
  for (const RegionBeat& region : region_beats(counts, beat)) {
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
