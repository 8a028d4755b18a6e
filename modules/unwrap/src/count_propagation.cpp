// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/count_propagation.hpp"

#include "fast_math.hpp"
#include "vector_clones.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

enum From { left, right, above, below };

/// Rows treated at a time: their intermediate values stay in the first-level cache.
constexpr int block_rows = 10 * DiagonalLayout::lanes;

/// One number for each pixel of a block.
using Row = std::array<float, block_rows>;

/// Numbers of a block of pixels for every count, `step` apart.
template <class T>
struct Planes {
  T* data;
  std::size_t step;

  T* operator[](int count) const { return data + static_cast<std::size_t>(count) * step; }
};

/// Messages along one edge, from all pixels of a block.
struct Edge {
  Planes<const HalfFloat> back;  ///< the last message the other way
  Planes<HalfFloat> out;
  const float* same;
  const float* next;
};

/// A block of pixels of one diagonal, and what it sends to both neighbours on the next.
struct Block {
  int rows;
  int lanes;  ///< rows of whole vectors, of which the last ones have no pixel
  int counts;
  Planes<const HalfFloat> evidence;
  Planes<const HalfFloat> in_first;  ///< messages from both neighbours on the diagonal before
  Planes<const HalfFloat> in_second;
  Edge first;
  Edge second;
  float direction;  ///< −1 where the edges are stored the other way: their steps change sign
  float* scratch;   ///< room for 2 (counts + 2) rows; the first and the last of each half are 0
};

/// What a block's pixels have for one count: their evidence, and the messages of all neighbours.
struct Factors {
  const HalfFloat* evidence;
  const HalfFloat* in_first;
  const HalfFloat* in_second;
  const HalfFloat* back_first;
  const HalfFloat* back_second;

  Factors(const Block& block, int count)
      : evidence(block.evidence[count]),
        in_first(block.in_first[count]),
        in_second(block.in_second[count]),
        back_first(block.first.back[count]),
        back_second(block.second.back[count]) {}
};

/// What persists between blocks.
struct Buffers {
  std::array<std::vector<HalfFloat>, 4>& messages;
  const HalfFloat* ones;
  float* scratch;
};

enum class Sweep { forward, backward };

/// The pixels of diagonal d from `row` on, in a sweep to later or to earlier diagonals. `has_back`
/// is false before anything has been sent against the sweep.
Block block_at(const CountModel& model, const Buffers& buffers, Sweep sweep, int d, int row,
               bool has_back) {
  const DiagonalLayout& layout = model.layout();
  const auto counts = static_cast<std::size_t>(model.counts());
  const bool forward = sweep == Sweep::forward;
  const int next = forward ? d + 1 : d - 1;
  const std::size_t step = layout.plane_step(d);
  const std::size_t out_step = layout.plane_step(next);
  const std::size_t here = layout.place(d, row, counts);
  const std::size_t in_row = layout.place(next, row, counts);
  const std::size_t in_col = forward ? in_row + 1 : in_row - 1;
  // Edges are stored at their left or upper pixel.
  const std::size_t edge_right = layout.place(forward ? d : next, row, 1);
  const std::size_t edge_down = forward ? edge_right : edge_right - 1;
  const From along_row = forward ? left : right;
  const From along_col = forward ? above : below;
  const auto back = [&](From from) {
    return has_back ? Planes<const HalfFloat>{&buffers.messages[from][here], step}
                    : Planes<const HalfFloat>{buffers.ones, 0};
  };
  const int rows = std::min(block_rows, layout.end(d) - row);
  return {rows,
          DiagonalLayout::whole_vectors(rows),
          model.counts(),
          {&model.evidence()[here], step},
          {&buffers.messages[along_row][here], step},
          {&buffers.messages[along_col][here], step},
          {back(forward ? right : left),
           {&buffers.messages[along_row][in_row], out_step},
           &model.right().same[edge_right],
           &model.right().next[edge_right]},
          {back(forward ? below : above),
           {&buffers.messages[along_col][in_col], out_step},
           &model.down().same[edge_down],
           &model.down().next[edge_down]},
          forward ? 1.0F : -1.0F,
          buffers.scratch};
}

/// Equation 16, for the messages along one edge. `weighted` holds what remains of the beliefs
/// without the message the other way.
template <bool watches_change>
[[gnu::always_inline]] inline void send(const Block& block, const Edge& edge, const float* weighted,
                                        const Row& sum, Row& change) {
  const int lanes = block.lanes;
  Row scale;
  Row up;
  Row down;
#pragma GCC ivdep
  for (int i = 0; i < lanes; ++i) {
    const float step = block.direction * edge.next[i];
    up[i] = step > 0 ? step : 0;
    down[i] = step < 0 ? -step : 0;
    scale[i] = 1 / (sum[i] * (1 + edge.same[i] + up[i] + down[i]));
  }
  const float* same = edge.same;
  for (int n = 0; n < block.counts; ++n) {
    const float* at = weighted + n * block_rows;
    HalfFloat* out = edge.out[n];
#pragma GCC ivdep
    for (int i = 0; i < lanes; ++i) {
      const float total =
          sum[i] + same[i] * at[i] + up[i] * at[i - block_rows] + down[i] * at[i + block_rows];
      const float message = std::sqrt(total * scale[i]);
      if constexpr (watches_change) {
        const float difference = std::abs(message - widened(out[i]));
        change[i] = difference > change[i] ? difference : change[i];
      }
      out[i] = halved(message);
    }
  }
}

/// Builds and sends the messages of a block. Returns the largest change of any, if that is watched.
template <bool watches_change>
[[gnu::always_inline]] inline float build_and_send(const Block& block) {
  const int lanes = block.lanes;
  float* first = block.scratch + block_rows;
  float* second = first + (block.counts + 2) * block_rows;
  Row sum_first{};
  Row sum_second{};
  for (int n = 0; n < block.counts; ++n) {
    const Factors of(block, n);
    float* weighted_first = first + n * block_rows;
    float* weighted_second = second + n * block_rows;
#pragma GCC ivdep
    for (int i = 0; i < lanes; ++i) {
      const float to_first = widened(of.back_first[i]);
      const float to_second = widened(of.back_second[i]);
      const float shared = widened(of.evidence[i]) * widened(of.in_first[i]) *
                           widened(of.in_second[i]) / (to_first * to_second);
      weighted_first[i] = shared * to_second * to_second;
      weighted_second[i] = shared * to_first * to_first;
      sum_first[i] += weighted_first[i];
      sum_second[i] += weighted_second[i];
    }
  }
  Row change{};
  send<watches_change>(block, block.first, first, sum_first, change);
  send<watches_change>(block, block.second, second, sum_second, change);
  return *std::max_element(change.begin(), change.begin() + block.rows);
}

TOFMAP_VECTOR_CLONES void send_block(const Block& block) { build_and_send<false>(block); }

TOFMAP_VECTOR_CLONES float send_block_and_watch(const Block& block) {
  return build_and_send<true>(block);
}

/// The two most likely counts of a block and their probabilities.
struct BlockBeliefs {
  Row best;
  Row rival;
  Row best_count;
  Row rival_count;
};

/// Equation 15, where all messages have come in.
TOFMAP_VECTOR_CLONES void read_block(const Block& block, BlockBeliefs& out) {
  const int lanes = block.lanes;
  Row sum{};
  out.best.fill(-1);
  out.rival.fill(0);
  out.rival_count.fill(0);
  for (int n = 0; n < block.counts; ++n) {
    const Factors of(block, n);
    const auto count = static_cast<float>(n);
#pragma GCC ivdep
    for (int i = 0; i < lanes; ++i) {
      const float belief = widened(of.evidence[i]) * widened(of.in_first[i]) *
                           widened(of.in_second[i]) * widened(of.back_first[i]) *
                           widened(of.back_second[i]);
      sum[i] += belief;
      const bool is_best = belief > out.best[i];
      const bool is_rival = belief > out.rival[i];
      const float beaten = is_rival ? belief : out.rival[i];
      const float beaten_count = is_rival ? count : out.rival_count[i];
      out.rival[i] = is_best ? out.best[i] : beaten;
      out.rival_count[i] = is_best ? out.best_count[i] : beaten_count;
      out.best[i] = is_best ? belief : out.best[i];
      out.best_count[i] = is_best ? count : out.best_count[i];
    }
  }
#pragma GCC ivdep
  for (int i = 0; i < lanes; ++i) {
    out.best[i] /= sum[i];
    out.rival[i] = (out.rival[i] > 0 ? out.rival[i] : 0) / sum[i];
  }
}

}  // namespace

void CountPropagation::reset(const CountModel& model) {
  const DiagonalLayout& layout = model.layout();
  const auto counts = static_cast<std::size_t>(model.counts());
  for (auto& message : messages_) message.resize(layout.size(counts));
  scratch_.assign(2 * (counts + 2) * block_rows, 0.0F);
  ones_.assign(block_rows, half_one);
  for (int row = 0; row < layout.rows(); ++row) {
    clear(model, left, row, 0);
    clear(model, right, row, layout.cols() - 1);
  }
  for (int col = 0; col < layout.cols(); ++col) {
    clear(model, above, 0, col);
    clear(model, below, layout.rows() - 1, col);
  }
}

/// Nothing is ever sent from beyond the borders.
void CountPropagation::clear(const CountModel& model, int from, int row, int col) {
  const auto counts = static_cast<std::size_t>(model.counts());
  const std::size_t step = model.layout().plane_step(row + col);
  std::size_t at = model.layout().place(row + col, row, counts);
  auto& message = messages_[static_cast<std::size_t>(from)];
  for (std::size_t n = 0; n < counts; ++n, at += step) message[at] = half_one;
}

void CountPropagation::sweep_forward(const CountModel& model, bool is_first) {
  const DiagonalLayout& layout = model.layout();
  const Buffers buffers{messages_, ones_.data(), scratch_.data()};
  for (int d = 0; d < layout.diagonals(); ++d) {
    for (int row = layout.begin(d); row < layout.end(d); row += block_rows) {
      send_block(block_at(model, buffers, Sweep::forward, d, row, !is_first));
    }
    // The rows without a pixel at the end of the last vector have sent there.
    if (d + 1 < layout.rows()) clear(model, left, d + 1, 0);
  }
}

void CountPropagation::sweep_backward(const CountModel& model, CountBeliefs* beliefs) {
  const DiagonalLayout& layout = model.layout();
  const Buffers buffers{messages_, ones_.data(), scratch_.data()};
  BlockBeliefs read;
  for (int d = layout.diagonals() - 1; d >= 0; --d) {
    for (int row = layout.begin(d); row < layout.end(d); row += block_rows) {
      const Block block = block_at(model, buffers, Sweep::backward, d, row, true);
      if (beliefs == nullptr) {
        send_block(block);
        continue;
      }
      const double change = send_block_and_watch(block);
      beliefs->largest_message_change = std::max(beliefs->largest_message_change, change);
      read_block(block, read);
      for (int i = 0; i < block.rows; ++i) {
        const int v = row + i;
        const int u = d - v;
        const auto at = static_cast<std::size_t>(i);
        beliefs->count(v, u) = static_cast<std::uint8_t>(read.best_count[at]);
        beliefs->probability(v, u) = read.best[at];
        beliefs->rival(v, u) = static_cast<std::uint8_t>(read.rival_count[at]);
        beliefs->rival_probability(v, u) = read.rival[at];
      }
    }
    if (d >= layout.rows()) clear(model, below, layout.rows() - 1, d - layout.rows());
  }
}

CountBeliefs CountPropagation::run(const CountModel& model, int iterations) {
  reset(model);
  const int rows = model.layout().rows();
  const int cols = model.layout().cols();
  CountBeliefs beliefs{ImageU8(rows, cols), ImageF(rows, cols), ImageU8(rows, cols),
                       ImageF(rows, cols), iterations};
  for (int i = 0; i < iterations; ++i) {
    sweep_forward(model, i == 0);
    sweep_backward(model, i + 1 == iterations ? &beliefs : nullptr);
  }
  return beliefs;
}

}  // namespace tofmap
