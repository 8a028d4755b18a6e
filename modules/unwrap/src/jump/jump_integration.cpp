// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/jump_integration.hpp"

#include "jump/configurations.hpp"
#include "jump/offset_union.hpp"
#include "jump/region_fits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>

#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// A jump node between the pixels p and q, which are indices row by row, with its most probable
/// step.
struct Bridge {
  int p;
  int q;
  int step;         ///< n(q) − n(p)
  float certainty;  ///< marginal probability of the step
  int rank_step;    ///< see rank_step(); 0 is the highest rank
};

/// The most probable steps of all jump nodes of one direction, at the indices of their pixels p.
struct Decisions {
  std::vector<std::int8_t> step;  ///< n(q) − n(p)
  std::vector<float> support;     ///< marginal probability of the step times its evidence (equation
                                  ///< 9); NaN where there is no node

  explicit Decisions(Eigen::Index pixels)
      : step(static_cast<std::size_t>(pixels)), support(step.size(), nan) {}
};

using ReadConfigurations = Configurations<const float>;

TOFMAP_VECTOR_CLONES void decide(int nodes, const ReadConfigurations& marginal_,
                                 const ReadConfigurations& evidence_, std::int8_t* step,
                                 float* support) {
  const ReadConfigurations marginal = marginal_;
  const ReadConfigurations evidence = evidence_;
#pragma GCC ivdep
  for (int i = 0; i < nodes; ++i) {
    const float minus = marginal.minus[i];
    const float none = marginal.none[i];
    const float plus = marginal.plus[i];
    const bool is_minus = minus >= plus;
    const float side = is_minus ? minus : plus;
    const float side_evidence = is_minus ? evidence.minus[i] : evidence.plus[i];
    const bool is_none = none >= side;
    // Configuration −1 means that the wrap count grows by one.
    const int side_step = is_minus ? 1 : -1;
    step[i] = static_cast<std::int8_t>(is_none ? 0 : side_step);
    support[i] = is_none ? none * evidence.none[i] : side * side_evidence;
  }
}

Decisions decided(const std::array<ImageF, 3>& marginal, const std::array<ImageF, 3>& evidence,
                  Eigen::Index rows, Eigen::Index cols) {
  Decisions out(rows * cols);
  for (Eigen::Index v = 0; v < marginal[0].rows(); ++v) {
    decide(static_cast<int>(marginal[0].cols()), ReadConfigurations(marginal, v),
           ReadConfigurations(evidence, v), out.step.data() + v * cols,
           out.support.data() + v * cols);
  }
  return out;
}

/// The largest of the values that are not NaN; at least 0.
TOFMAP_VECTOR_CLONES float greatest_of(const float* values, int count) {
  constexpr int lanes = DiagonalLayout::lanes;
  std::array<float, lanes> greatest{};
  const int whole = count / lanes * lanes;
  for (int i = 0; i < whole; i += lanes) {
#pragma GCC ivdep
    for (int k = 0; k < lanes; ++k) {
      float& lane = greatest[static_cast<std::size_t>(k)];
      lane = values[i + k] > lane ? values[i + k] : lane;
    }
  }
  float result = 0;
  for (int i = whole; i < count; ++i) result = values[i] > result ? values[i] : result;
  for (const float lane : greatest) result = lane > result ? lane : result;
  return result;
}

// Bridges are sorted by rank with a bucket sort, which takes linear time. The buckets are steps of
// 1 − rank on a logarithmic scale, eight per octave, down to the rounding error of a float.
constexpr float least_lack = 1.0F / (1 << 24);
constexpr int step_of_lack(float lack) {
  constexpr int shift = 20;  // leaves the exponent and three binary digits
  return (std::bit_cast<std::int32_t>(lack) - std::bit_cast<std::int32_t>(least_lack)) >> shift;
}
constexpr int rank_steps = step_of_lack(1) + 1;
int rank_step(float rank) { return step_of_lack(std::max(1 - rank, least_lack)); }

/// All bridges of a frame. The rank of a bridge is its support over the largest support in the
/// frame, since the support that a node can reach depends on the trust in the terms of the
/// evidence.
class Bridges {
 public:
  Bridges(const JumpProbabilities& marginals, const JumpProbabilities& evidence)
      : marginals_(marginals),
        rows_(static_cast<int>(marginals.x[0].rows())),
        cols_(static_cast<int>(marginals.y[0].cols())),
        x_(decided(marginals.x, evidence.x, rows_, cols_)),
        y_(decided(marginals.y, evidence.y, rows_, cols_)) {
    const int pixels = rows_ * cols_;
    greatest_ =
        std::max(greatest_of(x_.support.data(), pixels), greatest_of(y_.support.data(), pixels));
  }

  int rows() const { return rows_; }
  int cols() const { return cols_; }

  /// Whether the jump node between pixel p and its right or lower neighbour is certain, that is,
  /// its rank is at least 0.99. Certain nodes need no order among themselves.
  bool is_certain_right_of(int p) const { return is_certain(x_, p); }
  bool is_certain_below(int p) const { return is_certain(y_, p); }

  /// n(q) − n(p) of the right or lower neighbour q, if there is a jump node.
  int step_right_of(int p) const { return x_.step[static_cast<std::size_t>(p)]; }
  int step_below(int p) const { return y_.step[static_cast<std::size_t>(p)]; }

  /// The bridges for which `is_wanted(p, q)` is true, from the highest rank to the lowest. Bridges
  /// of the same rank step keep the order of the image.
  template <class IsWanted>
  std::vector<Bridge> sorted(const IsWanted& is_wanted) const {
    std::array<int, rank_steps + 1> first{};
    std::vector<Bridge> wanted;
    const auto append = [&](const Decisions& nodes, const std::array<ImageF, 3>& marginal, int p,
                            int q, int node) {
      const auto i = static_cast<std::size_t>(p);
      if (std::isnan(nodes.support[i]) || !is_wanted(p, q)) return;
      const int rank = rank_step(nodes.support[i] / greatest_);
      ++first[static_cast<std::size_t>(rank) + 1];
      const int step = nodes.step[i];
      wanted.push_back(
          {p, q, step, marginal[static_cast<std::size_t>(1 - step)].data()[node], rank});
    };
    for (int row = 0; row < rows_; ++row) {
      for (int p = row * cols_; p < (row + 1) * cols_; ++p) {
        append(x_, marginals_.x, p, p + 1, p - row);  // rows of x nodes are shorter by one
        append(y_, marginals_.y, p, p + cols_, p);
      }
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Bridge> sorted(wanted.size());
    for (const Bridge& bridge : wanted) {
      int& place = first[static_cast<std::size_t>(bridge.rank_step)];
      sorted[static_cast<std::size_t>(place++)] = bridge;
    }
    return sorted;
  }

 private:
  bool is_certain(const Decisions& nodes, int p) const {
    constexpr float certain = 0.99F;
    return nodes.support[static_cast<std::size_t>(p)] >= certain * greatest_;
  }

  const JumpProbabilities& marginals_;
  int rows_;
  int cols_;
  Decisions x_;
  Decisions y_;
  float greatest_ = 0;  ///< largest support in the frame
};

/// Converts the forest into images. Regions are numbered in the order of the image; `anchor(root)`
/// gives the absolute wrap count of a root.
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

/// Joins the trees of the pixels p and q, with n(q) − n(p) = step: the smaller tree becomes part of
/// the larger one. Does nothing if p and q are in the same tree, or if
/// `may_join(root, child, offset)` of their roots returns false.
template <class MayJoin>
void join_trees(int pixel_p, int pixel_q, int step, OffsetUnion& forest, const MayJoin& may_join) {
  const OffsetUnion::Place p = forest.find(pixel_p);
  const OffsetUnion::Place q = forest.find(pixel_q);
  if (p.root == q.root) return;
  const int offset = p.offset + step - q.offset;
  const bool p_is_larger = forest.size(p.root) >= forest.size(q.root);
  const int root = p_is_larger ? p.root : q.root;
  const int child = p_is_larger ? q.root : p.root;
  const int child_offset = p_is_larger ? offset : -offset;
  if (may_join(root, child, child_offset)) forest.join(root, child, child_offset);
}

/// Joins pixels along all certain bridges for which `is_undisputed(p, q, step)` is true. These are
/// most of the bridges; joining them row by row is cheap.
template <class IsUndisputed>
class CertainJoins {
 public:
  CertainJoins(const Bridges& bridges, const IsUndisputed& is_undisputed, OffsetUnion& forest)
      : bridges_(bridges),
        is_undisputed_(is_undisputed),
        forest_(forest),
        run_(static_cast<std::size_t>(bridges.cols())),
        run_above_(run_.size()) {}

  void join() {
    for (int row = 0; row < bridges_.rows(); ++row) {
      const int begin = row * bridges_.cols();
      join_runs(begin);
      if (row > 0) join_to_row_above(begin);
      std::swap(run_, run_above_);
    }
    forest_.flatten();
  }

 private:
  /// Joins the pixels of a row. Each run of joined pixels becomes a tree of depth one.
  void join_runs(int begin) {
    int run = begin;
    int offset = 0;
    run_[0] = run;
    for (std::size_t u = 1; u < run_.size(); ++u) {
      const int q = begin + static_cast<int>(u);
      const int step = bridges_.step_right_of(q - 1);
      if (bridges_.is_certain_right_of(q - 1) && is_undisputed_(q - 1, q, step)) {
        offset += step;
        forest_.join(run, q, offset);
      } else {
        run = q;
        offset = 0;
      }
      run_[u] = run;
    }
  }

  /// Joins the runs of a row to those of the row above. One bridge between two runs is enough.
  void join_to_row_above(int begin) {
    int joined_above = -1;
    int joined = -1;
    for (std::size_t u = 0; u < run_.size(); ++u) {
      if (run_above_[u] == joined_above && run_[u] == joined) continue;
      const int p = begin - bridges_.cols() + static_cast<int>(u);
      const int q = begin + static_cast<int>(u);
      const int step = bridges_.step_below(p);
      if (!bridges_.is_certain_below(p) || !is_undisputed_(p, q, step)) continue;
      joined_above = run_above_[u];
      joined = run_[u];
      join_trees(p, q, step, forest_, [](int, int, int) { return true; });
    }
  }

  const Bridges& bridges_;
  const IsUndisputed& is_undisputed_;
  OffsetUnion& forest_;
  std::vector<int> run_;  ///< the first pixel of the run of each pixel
  std::vector<int> run_above_;
};

/// Joins trees along the other bridges, from the highest rank to the lowest. Before each join,
/// `may_join(root, child, offset, certainty)` decides whether the tree with the root `child`
/// becomes part of the larger one with the root `root`. If it returns true, the trees are joined.
template <class MayJoin>
void join_others(const Bridges& bridges, OffsetUnion& forest, const MayJoin& may_join) {
  const auto is_open = [&](int p, int q) { return forest.parent(p) != forest.parent(q); };
  for (const Bridge& bridge : bridges.sorted(is_open)) {
    join_trees(bridge.p, bridge.q, bridge.step, forest, [&](int root, int child, int offset) {
      return may_join(root, child, offset, bridge.certainty);
    });
  }
}

/// Anchors every region so that its smallest wrap count is 0.
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
  const Bridges bridges(marginals, evidence);
  OffsetUnion forest(static_cast<int>(valid.size()));
  CertainJoins(
      bridges, [](int, int, int) { return true; }, forest)
      .join();
  join_others(bridges, forest, [](int, int, int, float) { return true; });
  RelativeCounts counts = read_forest(forest, valid, [](int) { return 0; });
  anchor_at_zero(counts);
  return counts;
}

RelativeCounts integrate_jumps_with_residual(const JumpProbabilities& marginals,
                                             const JumpProbabilities& evidence,
                                             const ImageU8& valid, const ResidualCost& residual,
                                             const ImageU8& nearest, double objection_share) {
  const Bridges bridges(marginals, evidence);
  OffsetUnion forest(static_cast<int>(valid.size()));
  const auto residual_agrees = [&](int p, int q, int step) {
    return nearest.data()[p] + step == nearest.data()[q];
  };
  CertainJoins(bridges, residual_agrees, forest).join();
  RegionFits fits(residual, nearest, forest);
  const auto may_join = [&](int root, int child, int offset, float certainty) {
    return fits.join(root, child, offset, certainty, objection_share);
  };
  join_others(bridges, forest, may_join);
  return read_forest(forest, valid, [&](int root) { return fits.best_count(root); });
}

}  // namespace tofmap
