// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_propagation.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The edges of a pixel to its left and its upper neighbour.
enum Neighbour { left, above };

/// Rows processed at a time: few enough to fit into the second-level cache, and enough for long
/// contiguous reads from memory.
constexpr int block_rows = 32 * DiagonalLayout::lanes;

/// The change of messages is measured on every n-th diagonal. That costs little, and the largest
/// change of the sample is close to that of all messages.
constexpr int watched_diagonals = 8;

/// One number for each pixel of a block.
using Row = std::array<float, block_rows>;

/// One plane for each wrap count with the values of a block of pixels; planes are `step` apart.
template <class T>
struct Planes {
  T* data;
  std::size_t step;

  T* operator[](int count) const { return data + static_cast<std::size_t>(count) * step; }
};

/// The edges from the pixels of a block to one of their neighbours on the next diagonal of the
/// sweep.
struct Edge {
  Planes<const BFloat16> back;  ///< the latest messages from that neighbour, or ones
  Planes<BFloat16> out;         ///< the messages to that neighbour; in the place of `back`
  const float* same;            ///< WrapCountModel::Edges::same
  const float* next;            ///< WrapCountModel::Edges::next
};

/// A block of pixels on one diagonal, and their edges to both neighbours on the next diagonal of
/// the sweep.
struct Block {
  int rows;
  int lanes;  ///< `rows`, rounded up to whole vectors; the last ones may be padding
  int counts;
  Planes<const BFloat16> evidence;
  Planes<const BFloat16> in_first;   ///< messages from the first neighbour on the diagonal before
  Planes<const BFloat16> in_second;  ///< messages from the second one
  Edge first;
  Edge second;
  float direction;  ///< 1 if edges are stored at this pixel, −1 if at the neighbour: the sign of i
  float* scratch;   ///< memory for 2 (counts + 1) vectors; the last one of each half is 0
};

/// The factors of a belief for one wrap count: unary factors and the messages of all neighbours.
struct Factors {
  const BFloat16* evidence;
  const BFloat16* in_first;
  const BFloat16* in_second;
  const BFloat16* back_first;
  const BFloat16* back_second;

  Factors(const Block& block, int count)
      : evidence(block.evidence[count]),
        in_first(block.in_first[count]),
        in_second(block.in_second[count]),
        back_first(block.first.back[count]),
        back_second(block.second.back[count]) {}

  /// Prefetches what follows `row`: there are more planes than the hardware prefetcher follows.
  [[gnu::always_inline]] void prefetch(int row) const {
    constexpr int ahead = 64;
    for (const BFloat16* plane : {evidence, in_first, in_second, back_first, back_second}) {
      __builtin_prefetch(plane + row + ahead);
    }
  }
};

/// The buffers that all blocks share. The messages along an edge in both directions have one place,
/// at the right or lower pixel of the edge. A pixel reads the incoming message before its own
/// message in the opposite direction replaces it.
struct Buffers {
  std::array<std::vector<BFloat16>, 2>& messages;
  const BFloat16* ones;
  float* scratch;
};

enum class Sweep { forward, backward };

/// The block of pixels on diagonal d that begins at `row`. `has_back` is false as long as no
/// message has been sent in the direction opposite to the sweep.
Block block_at(const WrapCountModel& model, const Buffers& buffers, Sweep sweep, int d, int row,
               bool has_back) {
  const DiagonalLayout& layout = model.layout();
  const auto counts = static_cast<std::size_t>(model.counts());
  const bool forward = sweep == Sweep::forward;
  // Messages from and to the left and upper neighbours are stored here, those from and to the right
  // and lower neighbours there.
  const std::size_t here = layout.place(d, row, counts);
  const std::size_t there = layout.place(d + 1, row, counts);
  const Planes<BFloat16> to_left{&buffers.messages[left][here], layout.plane_step(d)};
  const Planes<BFloat16> to_above{&buffers.messages[above][here], layout.plane_step(d)};
  const Planes<BFloat16> to_right{&buffers.messages[left][there], layout.plane_step(d + 1)};
  const Planes<BFloat16> to_below{&buffers.messages[above][there + 1], layout.plane_step(d + 1)};
  const auto read_only = [](const Planes<BFloat16>& planes) {
    return Planes<const BFloat16>{planes.data, planes.step};
  };
  // Pairwise factors are stored at the left or upper pixel of the edge.
  const std::size_t edge_right = layout.place(forward ? d : d - 1, row, 1);
  const std::size_t edge_down = forward ? edge_right : edge_right - 1;
  const auto edge = [&](const Planes<BFloat16>& slot, const WrapCountModel::Edges& edges,
                        std::size_t place) {
    return Edge{has_back ? read_only(slot) : Planes<const BFloat16>{buffers.ones, 0}, slot,
                &edges.same[place], &edges.next[place]};
  };
  const int rows = std::min(block_rows, layout.end(d) - row);
  return {rows,
          DiagonalLayout::whole_vectors(rows),
          model.counts(),
          {&model.evidence()[here], layout.plane_step(d)},
          read_only(forward ? to_left : to_right),
          read_only(forward ? to_above : to_below),
          edge(forward ? to_right : to_left, model.right(), edge_right),
          edge(forward ? to_below : to_above, model.down(), edge_down),
          forward ? 1.0F : -1.0F,
          buffers.scratch};
}

/// Scales products of two messages, 1e-24 … 1, so that the product of two of them is a normal
/// float.
constexpr float large = 0x1p40F;

/// One number for each pixel of a vector. It stays in a register during loops over the wrap counts.
using Lanes [[gnu::vector_size(DiagonalLayout::lanes * sizeof(float))]] = float;
using LaneBits [[gnu::vector_size(sizeof(Lanes))]] = std::uint32_t;
using LaneHalves [[gnu::vector_size(sizeof(Lanes) / 2)]] = BFloat16;

template <class Vector, class Number>
[[gnu::always_inline]] inline Vector load(const Number* from) {
  Vector vector;
  std::memcpy(&vector, from, sizeof(vector));
  return vector;
}

template <class Vector, class Number>
[[gnu::always_inline]] inline void store(const Vector& vector, Number* to) {
  std::memcpy(to, &vector, sizeof(vector));
}

[[gnu::always_inline]] inline Lanes widened_lanes(const BFloat16* from) {
  std::array<std::uint32_t, DiagonalLayout::lanes> bits;
  for (std::size_t k = 0; k < bits.size(); ++k) {
    bits[k] = static_cast<std::uint32_t>(from[k]) << 16U;
  }
  return std::bit_cast<Lanes>(bits);
}

[[gnu::always_inline]] inline void store_narrowed(const Lanes& lanes, BFloat16* to) {
  const LaneBits rounded = (std::bit_cast<LaneBits>(lanes) + 0x8000U) >> 16U;
  store(__builtin_convertvector(rounded, LaneHalves), to);
}

/// 1 / √x of positive normal numbers, with a relative error of at most 5e-6: two steps of Newton's
/// method from an estimate that halves the exponent.
[[gnu::always_inline]] inline Lanes inverse_root_of(const Lanes& x) {
  const Lanes half = 0.5F * x;
  Lanes root = std::bit_cast<Lanes>(0x5f375a86U - (std::bit_cast<LaneBits>(x) >> 1U));
  root *= 1.5F - half * root * root;
  root *= 1.5F - half * root * root;
  return root;
}

/// Equation 16 for one vector of pixels, which begins at `row` of the block: computes and stores
/// the messages along one edge. `weighted` holds, for each wrap count, the beliefs divided by the
/// message in the opposite direction, then a vector of zeros; `sum` is their sum.
[[gnu::always_inline]] inline void send(const Block& block, const Edge& edge, int row,
                                        const float* weighted, const Lanes& sum) {
  const Lanes none{};
  const auto same = load<Lanes>(edge.same + row);
  const Lanes step = block.direction * load<Lanes>(edge.next + row);
  const Lanes up = step > none ? step : none;
  const Lanes down = step < none ? -step : none;
  const Lanes scale = 1.0F / (sum * (1.0F + same + up + down));
  Lanes before = none;
  auto here = load<Lanes>(weighted);
  for (int n = 0; n < block.counts; ++n) {
    const auto after = load<Lanes>(weighted + (n + 1) * DiagonalLayout::lanes);
    const Lanes total = sum + same * here + up * before + down * after;
    store_narrowed(total * scale, edge.out[n] + row);
    before = here;
    here = after;
  }
}

/// Computes and sends the messages of a block.
TOFMAP_VECTOR_CLONES void send_block(const Block& block_) {
  const Block block = block_;
  float* first = block.scratch;
  float* second = first + (block.counts + 1) * DiagonalLayout::lanes;
  for (int i = 0; i < block.lanes; i += DiagonalLayout::lanes) {
    Lanes sum_first{};
    Lanes sum_second{};
    for (int n = 0; n < block.counts; ++n) {
      const Factors of(block, n);
      of.prefetch(i);
      const Lanes to_first = widened_lanes(of.back_first + i);
      const Lanes to_second = widened_lanes(of.back_second + i);
      // √(in / out) = in / √(in · out).
      const Lanes in = large * widened_lanes(of.in_first + i) * widened_lanes(of.in_second + i);
      const Lanes out = large * to_first * to_second;
      const Lanes shared = widened_lanes(of.evidence + i) * in * inverse_root_of(in * out);
      const Lanes without_first = shared * to_second;
      const Lanes without_second = shared * to_first;
      store(without_first, first + n * DiagonalLayout::lanes);
      store(without_second, second + n * DiagonalLayout::lanes);
      sum_first += without_first;
      sum_second += without_second;
    }
    send(block, block.first, i, first, sum_first);
    send(block, block.second, i, second, sum_second);
  }
}

/// The largest difference between the messages along one edge of each pixel and earlier ones.
TOFMAP_VECTOR_CLONES float largest_change(const Block& block, const Planes<const BFloat16>& now,
                                          const Planes<const BFloat16>& before) {
  Row largest{};
  for (int n = 0; n < block.counts; ++n) {
    const BFloat16* one = now[n];
    const BFloat16* other = before[n];
#pragma GCC ivdep
    for (int i = 0; i < block.lanes; ++i) {
      const float change = std::abs(std::sqrt(to_float(one[i])) - std::sqrt(to_float(other[i])));
      largest[i] = change > largest[i] ? change : largest[i];
    }
  }
  return *std::max_element(largest.begin(), largest.begin() + block.rows);
}

/// The two most probable wrap counts of each pixel of a block and their probabilities.
struct BlockBeliefs {
  Row best;
  Row runner_up;
  Row best_count;
  Row runner_up_count;
  Row others;  ///< probability of all wrap counts but the best
};

/// Equation 15, for a block that has received all its messages.
TOFMAP_VECTOR_CLONES void read_block(const Block& block_, BlockBeliefs& out) {
  const Block block = block_;
  const Lanes none{};
  for (int i = 0; i < block.lanes; i += DiagonalLayout::lanes) {
    Lanes best = none - 1.0F;
    Lanes runner_up = none - 1.0F;
    Lanes best_count = none;
    Lanes runner_up_count = none;
    Lanes sum = none;
    Lanes others = none;
    for (int n = 0; n < block.counts; ++n) {
      const Factors of(block, n);
      of.prefetch(i);
      const Lanes in = large * widened_lanes(of.in_first + i) * widened_lanes(of.in_second + i);
      const Lanes back =
          large * widened_lanes(of.back_first + i) * widened_lanes(of.back_second + i);
      // √(in · back) = x / √x.
      const Lanes belief = widened_lanes(of.evidence + i) * in * back * inverse_root_of(in * back);
      const Lanes count = none + static_cast<float>(n);
      sum += belief;
      const auto is_best = belief > best;
      const auto is_runner_up = belief > runner_up;
      const Lanes overtaken = best > none ? best : none;
      const Lanes beaten = is_runner_up ? belief : runner_up;
      const Lanes beaten_count = is_runner_up ? count : runner_up_count;
      others += is_best ? overtaken : belief;
      runner_up_count = is_best ? best_count : beaten_count;
      runner_up = is_best ? best : beaten;
      best_count = is_best ? count : best_count;
      best = is_best ? belief : best;
    }
    const auto write = [i](const Lanes& lanes, Row& row) { store(lanes, row.data() + i); };
    write(best / sum, out.best);
    write((runner_up > none ? runner_up : none) / sum, out.runner_up);
    write(others / sum, out.others);
    write(best_count, out.best_count);
    write(runner_up_count, out.runner_up_count);
  }
}

}  // namespace

void WrapCountPropagation::reset(const WrapCountModel& model) {
  const std::size_t size = model.layout().size(static_cast<std::size_t>(model.counts()));
  scratch_.assign(2 * static_cast<std::size_t>((model.counts() + 1) * DiagonalLayout::lanes), 0.0F);
  ones_.assign(block_rows, bfloat16_one);
  if (rows_ == model.layout().rows() && cols_ == model.layout().cols() &&
      counts_ == model.counts()) {
    return;
  }
  rows_ = model.layout().rows();
  cols_ = model.layout().cols();
  counts_ = model.counts();
  // Messages across the border of the image stay 1. Edges have no factors there, so messages that
  // are sent outwards are 1, too.
  for (auto& message : messages_) message.assign(size, bfloat16_one);
  for (auto& message : before_) message.assign(size, bfloat16_one);
}

void WrapCountPropagation::sweep_forward(const WrapCountModel& model, bool is_first) {
  const DiagonalLayout& layout = model.layout();
  const Buffers buffers{messages_, ones_.data(), scratch_.data()};
  for (int d = 0; d < layout.diagonals(); ++d) {
    for (int row = layout.begin(d); row < layout.end(d); row += block_rows) {
      send_block(block_at(model, buffers, Sweep::forward, d, row, !is_first));
    }
  }
}

void WrapCountPropagation::sweep_backward(const WrapCountModel& model) {
  const DiagonalLayout& layout = model.layout();
  const Buffers buffers{messages_, ones_.data(), scratch_.data()};
  for (int d = layout.diagonals() - 1; d >= 0; --d) {
    for (int row = layout.begin(d); row < layout.end(d); row += block_rows) {
      send_block(block_at(model, buffers, Sweep::backward, d, row, true));
    }
  }
}

/// The last backward sweep. Before a pixel sends its messages it has received all messages of its
/// neighbours, so its belief is read then.
void WrapCountPropagation::read_backward(const WrapCountModel& model, WrapCountBeliefs& beliefs) {
  const DiagonalLayout& layout = model.layout();
  const auto counts = static_cast<std::size_t>(model.counts());
  const Buffers buffers{messages_, ones_.data(), scratch_.data()};
  BlockBeliefs read;
  float change = 0;
  for (int d = layout.diagonals() - 1; d >= 0; --d) {
    for (int row = layout.begin(d); row < layout.end(d); row += block_rows) {
      const Block block = block_at(model, buffers, Sweep::backward, d, row, true);
      read_block(block, read);
      for (int i = 0; i < block.rows; ++i) {
        const int v = row + i;
        const int u = d - v;
        const auto at = static_cast<std::size_t>(i);
        beliefs.count(v, u) = static_cast<std::uint8_t>(read.best_count[at]);
        beliefs.probability(v, u) = read.best[at];
        beliefs.other_probability(v, u) = read.others[at];
        beliefs.runner_up(v, u) = static_cast<std::uint8_t>(read.runner_up_count[at]);
        beliefs.runner_up_probability(v, u) = read.runner_up[at];
      }
      send_block(block);
      if (d % watched_diagonals != 0) continue;
      const std::size_t here = layout.place(d, row, counts);
      for (const Neighbour to : {left, above}) {
        const Edge& edge = to == left ? block.first : block.second;
        const Planes<const BFloat16> before{&before_[to][here], layout.plane_step(d)};
        change = std::max(change, largest_change(block, edge.back, before));
      }
    }
  }
  beliefs.largest_message_change = change;
}

/// Copies the messages whose change the last backward sweep will measure: those of the backward
/// sweep before it, or ones if there was none.
void WrapCountPropagation::remember_watched(const WrapCountModel& model, bool was_sent) {
  const DiagonalLayout& layout = model.layout();
  const auto counts = static_cast<std::size_t>(model.counts());
  for (int d = 0; d < layout.diagonals(); d += watched_diagonals) {
    const std::size_t first = layout.place(d, layout.begin(d) - 1, counts);
    const std::size_t size = layout.plane_step(d) * counts;
    for (const Neighbour to : {left, above}) {
      BFloat16* before = before_[to].data() + first;
      if (was_sent) {
        std::copy_n(messages_[to].data() + first, size, before);
      } else {
        std::fill_n(before, size, bfloat16_one);
      }
    }
  }
}

WrapCountBeliefs WrapCountPropagation::run(const WrapCountModel& model, int iterations) {
  reset(model);
  const int rows = model.layout().rows();
  const int cols = model.layout().cols();
  WrapCountBeliefs beliefs{.count = ImageU8(rows, cols),
                           .probability = ImageF(rows, cols),
                           .other_probability = ImageF(rows, cols),
                           .runner_up = ImageU8(rows, cols),
                           .runner_up_probability = ImageF(rows, cols),
                           .iterations = iterations};
  for (int i = 0; i + 1 < iterations; ++i) {
    sweep_forward(model, i == 0);
    sweep_backward(model);
  }
  remember_watched(model, iterations > 1);
  sweep_forward(model, iterations == 1);
  read_backward(model, beliefs);
  return beliefs;
}

}  // namespace tofmap
