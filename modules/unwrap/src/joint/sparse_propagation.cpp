// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/sparse_propagation.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Numbers for successive wrap counts.
constexpr std::size_t lanes = 8;
using CountLanes [[gnu::vector_size(lanes * sizeof(float))]] = float;

[[gnu::always_inline]] inline CountLanes load_lanes(const float* from) {
  CountLanes out;
  std::memcpy(&out, from, sizeof(out));
  return out;
}

[[gnu::always_inline]] inline void store_lanes(const CountLanes& values, float* to) {
  std::memcpy(to, &values, sizeof(values));
}

[[gnu::always_inline]] inline CountLanes root_of(const CountLanes& x) {
  CountLanes out;
  for (std::size_t k = 0; k < lanes; ++k) out[k] = std::sqrt(x[k]);
  return out;
}

[[gnu::always_inline]] inline float sum_of(const CountLanes& x) {
  return ((x[0] + x[4]) + (x[1] + x[5])) + ((x[2] + x[6]) + (x[3] + x[7]));
}

[[gnu::always_inline]] inline CountLanes keep_where(const CountLanes& one, const CountLanes& other,
                                                    const CountLanes& values) {
  using Bits [[gnu::vector_size(lanes * sizeof(float))]] = std::int32_t;
  const Bits are_equal = one == other;
  return std::bit_cast<CountLanes>(are_equal & std::bit_cast<Bits>(values));
}

constexpr std::size_t stride = UncertainPixels::slots;
static_assert(stride % lanes == 0);

/// The graph of uncertain pixels, as loops need it.
struct Graph {
  std::size_t pixels;
  const float* evidence;
  const float* counts;  ///< in the slots
  float* messages;
  std::array<const int*, 4> neighbour;  ///< left, above, right, below
  std::array<const float*, 2> same;     ///< right, below
  std::array<const float*, 2> next;
};

/// The messages along the edges of a pixel. Those in both directions have one place, as in
/// WrapCountPropagation.
struct Messages {
  std::array<float*, 4> at;  ///< left, above, right, below; ones where there is no neighbour

  [[gnu::always_inline]] Messages(const Graph& graph, std::size_t pixel) {
    float* ones = graph.messages + 2 * graph.pixels * stride;
    for (std::size_t d = 0; d < 2; ++d) {
      float* own = graph.messages + (2 * pixel + d) * stride;
      at[d] = graph.neighbour[d][pixel] < 0 ? ones : own;
      const int other = graph.neighbour[d + 2][pixel];
      at[d + 2] =
          other < 0 ? ones : graph.messages + (2 * static_cast<std::size_t>(other) + d) * stride;
    }
  }
};

/// Numbers of all slots of a pixel, with a vector before and after them.
using Padded = std::array<float, stride + 2 * lanes>;

/// Fills what stands before and after the slots: zeros, or, if wrap counts share slots, what
/// belongs to the wrap counts before and after.
template <bool share_slots>
[[gnu::always_inline]] inline void pad(Padded& numbers) {
  numbers[lanes - 1] = share_slots ? numbers[lanes + stride - 1] : 0.0F;
  numbers[lanes + stride] = share_slots ? numbers[lanes] : 0.0F;
}

/// The pairwise factors of an edge for a pixel that sends a message along it.
struct SentAlong {
  float same;
  float step;           ///< the factor of the next wrap count; negative for that before
  const float* counts;  ///< in the receiver's slots
};

/// Equation 16 along one edge. `counts` are those in the sender's slots.
template <bool share_slots>
[[gnu::always_inline]] inline void send_message(const Padded& weighted, const Padded& counts,
                                                float sum, const SentAlong& edge, float* out) {
  const float factor = edge.step > 0 ? edge.step : -edge.step;
  const float up = edge.step > 0 ? 1.0F : -1.0F;
  const std::size_t own = lanes;
  const std::size_t other = edge.step > 0 ? lanes - 1 : lanes + 1;
  const float scale = 1 / (sum * (1 + edge.same + factor));
  for (std::size_t n = 0; n < stride; n += lanes) {
    CountLanes same = load_lanes(&weighted[own + n]);
    CountLanes next = load_lanes(&weighted[other + n]);
    if constexpr (share_slots) {
      const CountLanes received = load_lanes(edge.counts + n);
      same = keep_where(load_lanes(&counts[own + n]), received, same);
      next = keep_where(load_lanes(&counts[other + n]) + up, received, next);
    }
    store_lanes((sum + edge.same * same + factor * next) * scale, out + n);
  }
}

/// Memory of a sweep.
struct Scratch {
  Padded first{};
  Padded second{};
  Padded counts{};
};

/// Sends the messages of a pixel along two edges. `in` and `out` are directions: 0 for left and
/// above, 2 for right and below.
template <bool share_slots, std::size_t in, std::size_t out>
[[gnu::always_inline]] inline void send_messages(const Graph& graph, std::size_t pixel,
                                                 Scratch& scratch) {
  constexpr bool forward = in == 0;
  const bool has_first = graph.neighbour[out][pixel] >= 0;
  const bool has_second = graph.neighbour[out + 1][pixel] >= 0;
  if (!has_first && !has_second) return;
  const Messages messages(graph, pixel);
  const float* evidence = graph.evidence + pixel * stride;
  CountLanes sum_first{};
  CountLanes sum_second{};
  for (std::size_t n = 0; n < stride; n += lanes) {
    const CountLanes to_first = load_lanes(messages.at[out] + n);
    const CountLanes to_second = load_lanes(messages.at[out + 1] + n);
    const CountLanes received =
        load_lanes(messages.at[in] + n) * load_lanes(messages.at[in + 1] + n);
    const CountLanes shared = load_lanes(evidence + n) * root_of(received / (to_first * to_second));
    const CountLanes without_first = shared * to_second;
    const CountLanes without_second = shared * to_first;
    store_lanes(without_first, &scratch.first[lanes + n]);
    store_lanes(without_second, &scratch.second[lanes + n]);
    sum_first += without_first;
    sum_second += without_second;
  }
  pad<share_slots>(scratch.first);
  pad<share_slots>(scratch.second);
  if constexpr (share_slots) {
    std::copy_n(graph.counts + pixel * stride, stride, &scratch.counts[lanes]);
    pad<share_slots>(scratch.counts);
  }
  const auto send = [&](std::size_t d, const Padded& weighted, const CountLanes& sum) {
    const auto receiver = static_cast<std::size_t>(graph.neighbour[out + d][pixel]);
    const std::size_t holder = forward ? pixel : receiver;
    const float step = graph.next[d][holder];
    const float* its_counts = share_slots ? graph.counts + receiver * stride : nullptr;
    send_message<share_slots>(weighted, scratch.counts, sum_of(sum),
                              {graph.same[d][holder], forward ? step : -step, its_counts},
                              messages.at[out + d]);
  };
  if (has_first) send(0, scratch.first, sum_first);
  if (has_second) send(1, scratch.second, sum_second);
}

template <bool share_slots, bool forward>
[[gnu::always_inline]] inline void sweep_all(const Graph& graph, Scratch& scratch) {
  for (std::size_t i = 0; i < graph.pixels; ++i) {
    if (forward) {
      send_messages<share_slots, 0, 2>(graph, i, scratch);
    } else {
      send_messages<share_slots, 2, 0>(graph, graph.pixels - 1 - i, scratch);
    }
  }
}

/// The two most probable wrap counts of a pixel and their probabilities.
struct PixelBelief {
  int best = 0;
  int runner_up = 0;
  float best_belief = -1;
  float runner_up_belief = -1;
  float others = 0;  ///< belief in all wrap counts but the best
};

/// Equation 15. `belief` is memory for the numbers of all slots.
[[gnu::always_inline]] inline PixelBelief read_belief(const Graph& graph, std::size_t pixel,
                                                      int used_slots, float* belief) {
  const Messages messages(graph, pixel);
  const float* evidence = graph.evidence + pixel * stride;
  for (std::size_t n = 0; n < stride; n += lanes) {
    const CountLanes one = load_lanes(messages.at[0] + n) * load_lanes(messages.at[1] + n);
    const CountLanes other = load_lanes(messages.at[2] + n) * load_lanes(messages.at[3] + n);
    store_lanes(load_lanes(evidence + n) * root_of(one) * root_of(other), belief + n);
  }
  PixelBelief out;
  for (int n = 0; n < used_slots; ++n) {
    const float here = belief[n];
    if (here > out.best_belief) {
      out.others += std::max(out.best_belief, 0.0F);
      out.runner_up = out.best;
      out.runner_up_belief = out.best_belief;
      out.best = n;
      out.best_belief = here;
      continue;
    }
    out.others += here;
    if (here > out.runner_up_belief) {
      out.runner_up = n;
      out.runner_up_belief = here;
    }
  }
  return out;
}

/// The last backward sweep. Before a pixel sends its messages it has received all messages of its
/// neighbours, so its belief is read then.
template <bool share_slots>
[[gnu::always_inline]] inline void read_all(const Graph& graph, int used_slots, const int* raster,
                                            Scratch& scratch, WrapCountBeliefs& beliefs) {
  for (std::size_t i = graph.pixels; i-- > 0;) {
    const PixelBelief read = read_belief(graph, i, used_slots, &scratch.first[lanes]);
    const int at = raster[i];
    const float sum = read.best_belief + read.others;
    const float* counts = share_slots ? graph.counts + i * stride : nullptr;
    const auto count_in = [&](int slot) {
      return static_cast<std::uint8_t>(share_slots ? static_cast<int>(counts[slot]) : slot);
    };
    beliefs.count.data()[at] = count_in(read.best);
    beliefs.probability.data()[at] = read.best_belief / sum;
    beliefs.other_probability.data()[at] = read.others / sum;
    beliefs.runner_up.data()[at] = count_in(read.runner_up);
    beliefs.runner_up_probability.data()[at] = std::max(read.runner_up_belief, 0.0F) / sum;
    send_messages<share_slots, 2, 0>(graph, i, scratch);
  }
}

TOFMAP_VECTOR_CLONES void sweep_forward(const Graph& graph, Scratch& scratch) {
  sweep_all<false, true>(Graph(graph), scratch);
}

TOFMAP_VECTOR_CLONES void sweep_backward(const Graph& graph, Scratch& scratch) {
  sweep_all<false, false>(Graph(graph), scratch);
}

TOFMAP_VECTOR_CLONES void read_backward(const Graph& graph, int used_slots, const int* raster,
                                        Scratch& scratch, WrapCountBeliefs& beliefs) {
  read_all<false>(Graph(graph), used_slots, raster, scratch, beliefs);
}

TOFMAP_VECTOR_CLONES void sweep_shared_forward(const Graph& graph, Scratch& scratch) {
  sweep_all<true, true>(Graph(graph), scratch);
}

TOFMAP_VECTOR_CLONES void sweep_shared_backward(const Graph& graph, Scratch& scratch) {
  sweep_all<true, false>(Graph(graph), scratch);
}

TOFMAP_VECTOR_CLONES void read_shared_backward(const Graph& graph, int used_slots,
                                               const int* raster, Scratch& scratch,
                                               WrapCountBeliefs& beliefs) {
  read_all<true>(Graph(graph), used_slots, raster, scratch, beliefs);
}

/// The change of messages is measured at every n-th pixel.
constexpr std::size_t watched_pixels = 16;

/// Calls `visit(first, size)` with the place of the messages of each watched pixel.
template <class Visit>
void for_each_watched(std::size_t pixels, const Visit& visit) {
  for (std::size_t i = 0; i < pixels; i += watched_pixels) visit(2 * i * stride, 2 * stride);
}

}  // namespace

WrapCountBeliefs SparsePropagation::run(const UncertainPixels& pixels, const OwnCounts& own,
                                        int iterations) {
  using Direction = UncertainPixels::Direction;
  const Eigen::Index rows = own.count.rows();
  const Eigen::Index cols = own.count.cols();
  WrapCountBeliefs beliefs{.count = own.count,
                           .probability = 1 / (1 + own.odds_against),
                           .other_probability = own.odds_against / (1 + own.odds_against),
                           .runner_up = own.count,
                           .runner_up_probability = ImageF::Zero(rows, cols),
                           .iterations = iterations};
  messages_.assign((2 * pixels.size() + 1) * stride, 1.0F);
  const auto neighbour = [&](Direction d) { return pixels.neighbours(d).data(); };
  const Graph graph{pixels.size(),
                    pixels.evidence().data(),
                    pixels.counts().data(),
                    messages_.data(),
                    {neighbour(Direction::left), neighbour(Direction::above),
                     neighbour(Direction::right), neighbour(Direction::below)},
                    {pixels.same(Direction::right).data(), pixels.same(Direction::below).data()},
                    {pixels.next(Direction::right).data(), pixels.next(Direction::below).data()}};
  const bool share = pixels.share_slots();
  Scratch scratch;
  const auto forward = [&] { (share ? sweep_shared_forward : sweep_forward)(graph, scratch); };
  for (int i = 0; i + 1 < iterations; ++i) {
    forward();
    (share ? sweep_shared_backward : sweep_backward)(graph, scratch);
  }
  before_.clear();
  for_each_watched(pixels.size(), [&](std::size_t first, std::size_t count) {
    before_.insert(before_.end(), &messages_[first], &messages_[first] + count);
  });
  forward();
  (share ? read_shared_backward : read_backward)(graph, static_cast<int>(pixels.used_slots()),
                                                 pixels.raster().data(), scratch, beliefs);
  const float* before = before_.data();
  for_each_watched(pixels.size(), [&](std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const float change = std::abs(std::sqrt(messages_[first + i]) - std::sqrt(*before++));
      beliefs.largest_message_change = std::max(beliefs.largest_message_change, double{change});
    }
  });
  return beliefs;
}

}  // namespace tofmap
