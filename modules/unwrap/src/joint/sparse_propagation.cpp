// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/sparse_propagation.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// Values of `place_` for pixels that are not uncertain.
constexpr int no_return = -2;
constexpr int is_certain = -1;

/// Smallest product of unary factor and messages of certain neighbours.
constexpr float least_evidence = 1e-24F;

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

/// The graph of uncertain pixels, as loops need it.
struct Graph {
  std::size_t pixels;
  std::size_t stride;
  const float* evidence;
  float* messages;
  std::array<const int*, 4> neighbour;  ///< left, above, right, below
  std::array<const float*, 2> same;     ///< right, below
  std::array<const float*, 2> next;
};

/// The messages along the edges of a pixel. Those in both directions have one place, as in
/// WrapCountPropagation.
struct Slots {
  std::array<float*, 4> at;  ///< left, above, right, below; ones where there is no neighbour

  [[gnu::always_inline]] Slots(const Graph& graph, std::size_t pixel) {
    float* ones = graph.messages + 2 * graph.pixels * graph.stride;
    for (std::size_t d = 0; d < 2; ++d) {
      float* own = graph.messages + (2 * pixel + d) * graph.stride;
      at[d] = graph.neighbour[d][pixel] < 0 ? ones : own;
      const int other = graph.neighbour[d + 2][pixel];
      at[d + 2] = other < 0
                      ? ones
                      : graph.messages + (2 * static_cast<std::size_t>(other) + d) * graph.stride;
    }
  }
};

/// Equation 16 along one edge. `weighted` is padded by a vector of zeros at both ends.
[[gnu::always_inline]] inline void send_message(const float* weighted, float sum, float same,
                                                float step, std::size_t stride, float* out) {
  const float up = step > 0 ? step : 0.0F;
  const float down = step < 0 ? -step : 0.0F;
  const float scale = 1 / (sum * (1 + same + up + down));
  for (std::size_t n = 0; n < stride; n += lanes) {
    const CountLanes total = sum + same * load_lanes(weighted + n) +
                             up * load_lanes(weighted + n - 1) +
                             down * load_lanes(weighted + n + 1);
    store_lanes(total * scale, out + n);
  }
}

/// Memory for the wrap counts of two edges, with a vector of zeros before and after each.
constexpr std::size_t scratch_stride = 256 + 2 * lanes;
using Scratch = std::array<float, 2 * scratch_stride>;

/// Sends the messages of a pixel along two edges. `in` and `out` are directions: 0 for left and
/// above, 2 for right and below.
template <std::size_t in, std::size_t out>
[[gnu::always_inline]] inline void send_messages(const Graph& graph, std::size_t pixel,
                                                 Scratch& scratch) {
  constexpr bool forward = in == 0;
  const bool has_first = graph.neighbour[out][pixel] >= 0;
  const bool has_second = graph.neighbour[out + 1][pixel] >= 0;
  if (!has_first && !has_second) return;
  const Slots slots(graph, pixel);
  const float* evidence = graph.evidence + pixel * graph.stride;
  float* first = scratch.data() + lanes;
  float* second = first + scratch_stride;
  CountLanes sum_first{};
  CountLanes sum_second{};
  for (std::size_t n = 0; n < graph.stride; n += lanes) {
    const CountLanes to_first = load_lanes(slots.at[out] + n);
    const CountLanes to_second = load_lanes(slots.at[out + 1] + n);
    const CountLanes received = load_lanes(slots.at[in] + n) * load_lanes(slots.at[in + 1] + n);
    const CountLanes shared = load_lanes(evidence + n) * root_of(received / (to_first * to_second));
    const CountLanes without_first = shared * to_second;
    const CountLanes without_second = shared * to_first;
    store_lanes(without_first, first + n);
    store_lanes(without_second, second + n);
    sum_first += without_first;
    sum_second += without_second;
  }
  store_lanes(CountLanes{}, first + graph.stride);
  store_lanes(CountLanes{}, second + graph.stride);
  const auto send = [&](std::size_t d, const float* weighted, const CountLanes& sum) {
    const auto holder = forward ? pixel : static_cast<std::size_t>(graph.neighbour[out + d][pixel]);
    const float step = graph.next[d][holder];
    send_message(weighted, sum_of(sum), graph.same[d][holder], forward ? step : -step, graph.stride,
                 slots.at[out + d]);
  };
  if (has_first) send(0, first, sum_first);
  if (has_second) send(1, second, sum_second);
}

TOFMAP_VECTOR_CLONES void sweep_forward(const Graph& graph_, Scratch& scratch) {
  const Graph graph = graph_;
  for (std::size_t i = 0; i < graph.pixels; ++i) send_messages<0, 2>(graph, i, scratch);
}

/// The two most probable wrap counts of a pixel and their probabilities.
struct PixelBelief {
  int best = 0;
  int runner_up = 0;
  float best_belief = -1;
  float runner_up_belief = -1;
  float others = 0;  ///< belief in all wrap counts but the best
};

/// Equation 15. `belief` is memory for one number for each wrap count.
[[gnu::always_inline]] inline PixelBelief read_belief(const Graph& graph, std::size_t pixel,
                                                      int counts, float* belief) {
  const Slots slots(graph, pixel);
  const float* evidence = graph.evidence + pixel * graph.stride;
  for (std::size_t n = 0; n < graph.stride; n += lanes) {
    const CountLanes one = load_lanes(slots.at[0] + n) * load_lanes(slots.at[1] + n);
    const CountLanes other = load_lanes(slots.at[2] + n) * load_lanes(slots.at[3] + n);
    store_lanes(load_lanes(evidence + n) * root_of(one) * root_of(other), belief + n);
  }
  PixelBelief out;
  for (int n = 0; n < counts; ++n) {
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

TOFMAP_VECTOR_CLONES void sweep_backward(const Graph& graph_, Scratch& scratch) {
  const Graph graph = graph_;
  for (std::size_t i = graph.pixels; i-- > 0;) send_messages<2, 0>(graph, i, scratch);
}

/// The last backward sweep. Before a pixel sends its messages it has received all messages of its
/// neighbours, so its belief is read then.
TOFMAP_VECTOR_CLONES void read_backward(const Graph& graph_, int counts, const int* raster,
                                        Scratch& scratch, WrapCountBeliefs& beliefs) {
  const Graph graph = graph_;
  for (std::size_t i = graph.pixels; i-- > 0;) {
    const PixelBelief read = read_belief(graph, i, counts, scratch.data() + lanes);
    const int at = raster[i];
    const float sum = read.best_belief + read.others;
    beliefs.count.data()[at] = static_cast<std::uint8_t>(read.best);
    beliefs.probability.data()[at] = read.best_belief / sum;
    beliefs.other_probability.data()[at] = read.others / sum;
    beliefs.runner_up.data()[at] = static_cast<std::uint8_t>(read.runner_up);
    beliefs.runner_up_probability.data()[at] = std::max(read.runner_up_belief, 0.0F) / sum;
    send_messages<2, 0>(graph, i, scratch);
  }
}

/// The change of messages is measured at every n-th pixel.
constexpr std::size_t watched_pixels = 16;

/// Calls `visit(first, size)` with the place of the messages of each watched pixel.
template <class Visit>
void for_each_watched(std::size_t pixels, std::size_t stride, const Visit& visit) {
  for (std::size_t i = 0; i < pixels; i += watched_pixels) visit(2 * i * stride, 2 * stride);
}

}  // namespace

void SparsePropagation::list_pixels(const Frame& frame, const OwnCounts& own) {
  const ImageF& phase = frame.phases[0];
  const auto cols = static_cast<int>(phase.cols());
  raster_.clear();
  column_.clear();
  place_.resize(static_cast<std::size_t>(phase.size()));
  int at = 0;
  for (Eigen::Index v = 0; v < phase.rows(); ++v) {
    for (int u = 0; u < cols; ++u, ++at) {
      int& place = place_[static_cast<std::size_t>(at)];
      place = is_certain;
      if (own.certain.data()[at] != 0) continue;
      place = no_return;
      if (std::isnan(phase.data()[at])) continue;
      place = static_cast<int>(raster_.size());
      raster_.push_back(at);
      column_.push_back(u);
    }
  }
}

void SparsePropagation::load(const Frame& frame, const UnwrapLimits& limits,
                             const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m,
                             const WrapCountPrior& prior, const ImageU8& mixed) {
  const auto padded =
      static_cast<std::size_t>(DiagonalLayout::whole_vectors(static_cast<int>(raster_.size())));
  pixels_.assign(padded, frame.frequencies(), static_cast<float>(prior.outlier_share));
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    const auto wavelength_m = static_cast<float>(limits.wavelengths_m[f]);
    const auto systematic_m2 = static_cast<float>(residual_sigma_m[f] * residual_sigma_m[f]);
    for (std::size_t i = 0; i < raster_.size(); ++i) {
      const int at = raster_[i];
      const float sigma_m = sigma.cycles[f].data()[at] * wavelength_m;
      pixels_.phases[f][i] = frame.phases[f].data()[at];
      pixels_.variances_m2[f][i] = sigma_m * sigma_m + systematic_m2;
    }
  }
  for (std::size_t i = 0; i < raster_.size(); ++i) {
    const int at = raster_[i];
    if (frame.has_amplitude()) pixels_.amplitude[i] = frame.amplitudes[0].data()[at];
    if (mixed.data()[at] != 0) pixels_.outlier_share[i] = mixed_outlier_share;
  }
}

void SparsePropagation::fill_unary(const UnwrapLimits& limits) {
  const std::size_t step = pixels_.amplitude.size();
  const auto counts = static_cast<std::size_t>(counts_);
  unary_.resize(step * counts);
  if (step > 0) {
    UnaryFactors(limits).fill(pixels_, 0, static_cast<int>(step), unary_.data(), step);
  }
  evidence_.assign(raster_.size() * stride_, 0.0F);
  for (std::size_t n = 0; n < counts; ++n) {
    const std::uint16_t* plane = unary_.data() + n * step;
    for (std::size_t i = 0; i < raster_.size(); ++i) {
      evidence_[i * stride_ + n] = to_float(plane[i]);
    }
  }
}

/// Multiplies the unary factors of a pixel by the message of a certain neighbour with this wrap
/// count: √ψ. `next` is negative if the pixel's wrap count may be smaller by one.
void SparsePropagation::absorb(std::size_t pixel, int count, float same, float next) {
  float* evidence = &evidence_[pixel * stride_];
  evidence[count] *= std::sqrt(1 + same);
  const int other = count + (next > 0 ? 1 : -1);
  if (other >= 0 && other < counts_) evidence[other] *= std::sqrt(1 + std::abs(next));
}

void SparsePropagation::scale_evidence(std::size_t pixel) {
  float* evidence = &evidence_[pixel * stride_];
  const float best = *std::max_element(evidence, evidence + counts_);
  for (int n = 0; n < counts_; ++n) evidence[n] = std::max(evidence[n] / best, least_evidence);
}

void SparsePropagation::fill_pairwise(const Frame& frame, const UnwrapLimits& limits,
                                      const PhaseSigma& sigma, const WrapCountPrior& prior,
                                      const OwnCounts& own) {
  const EdgeScale scale(limits, prior);
  const std::size_t padded = pixels_.amplitude.size();
  const auto cols = static_cast<int>(frame.cols());
  const auto size = static_cast<int>(frame.phases[0].size());
  const auto wavelength_m = static_cast<float>(limits.wavelength_m());
  std::vector<float> same(padded);
  std::vector<float> next(padded);
  for (const Direction direction : {left, above, right, below}) {
    const bool leads = direction == right || direction == below;
    const bool is_across = direction == left || direction == right;
    const int step = (is_across ? 1 : cols) * (leads ? 1 : -1);
    // The column that has no neighbour in this direction.
    const int end_col = leads ? cols - 1 : 0;
    std::vector<int>& neighbour = neighbour_[direction];
    neighbour.assign(raster_.size(), no_return);
    neighbours_.assign(padded, 1, 0);
    for (std::size_t i = 0; i < raster_.size(); ++i) {
      const int at = raster_[i] + step;
      if (at < 0 || at >= size || (is_across && column_[i] == end_col)) continue;
      neighbour[i] = place_[static_cast<std::size_t>(at)];
      if (neighbour[i] == no_return) continue;
      const float sigma_m = sigma.cycles[0].data()[at] * wavelength_m;
      neighbours_.phases[0][i] = frame.phases[0].data()[at];
      neighbours_.variances_m2[0][i] = sigma_m * sigma_m;
      if (frame.has_amplitude()) neighbours_.amplitude[i] = frame.amplitudes[0].data()[at];
    }
    const PixelsAt own_pixels{pixels_, 0};
    const PixelsAt other_pixels{neighbours_, 0};
    if (padded > 0) {
      fill_pairwise_factors(leads ? own_pixels : other_pixels, leads ? other_pixels : own_pixels,
                            static_cast<int>(padded), scale, same.data(), next.data());
    }
    for (std::size_t i = 0; i < raster_.size(); ++i) {
      if (neighbour[i] != is_certain) continue;
      const int count = own.count.data()[raster_[i] + step];
      absorb(i, count, same[i], leads ? -next[i] : next[i]);
    }
    if (!leads) continue;
    same_[direction - right] = same;
    next_[direction - right] = next;
  }
}

void SparsePropagation::assign(const Frame& frame, const UnwrapLimits& limits,
                               const PhaseSigma& sigma, const std::vector<double>& residual_sigma_m,
                               const WrapCountPrior& prior, const OwnCounts& own,
                               const ImageU8& mixed) {
  counts_ = limits.count;
  stride_ = (static_cast<std::size_t>(counts_) + lanes - 1) / lanes * lanes;
  list_pixels(frame, own);
  load(frame, limits, sigma, residual_sigma_m, prior, mixed);
  fill_unary(limits);
  fill_pairwise(frame, limits, sigma, prior, own);
  for (std::size_t i = 0; i < raster_.size(); ++i) scale_evidence(i);
}

void SparsePropagation::weigh_evidence(std::size_t pixel, std::span<const float> factors) {
  float* evidence = &evidence_[pixel * stride_];
  for (std::size_t n = 0; n < factors.size(); ++n) evidence[n] *= factors[n];
  scale_evidence(pixel);
}

WrapCountBeliefs SparsePropagation::run(const OwnCounts& own, int iterations) {
  const Eigen::Index rows = own.count.rows();
  const Eigen::Index cols = own.count.cols();
  WrapCountBeliefs beliefs{.count = own.count,
                           .probability = 1 / (1 + own.odds_against),
                           .other_probability = own.odds_against / (1 + own.odds_against),
                           .runner_up = own.count,
                           .runner_up_probability = ImageF::Zero(rows, cols),
                           .iterations = iterations};
  messages_.assign((2 * raster_.size() + 1) * stride_, 1.0F);
  const Graph graph{raster_.size(),
                    stride_,
                    evidence_.data(),
                    messages_.data(),
                    {neighbour_[left].data(), neighbour_[above].data(), neighbour_[right].data(),
                     neighbour_[below].data()},
                    {same_[0].data(), same_[1].data()},
                    {next_[0].data(), next_[1].data()}};
  Scratch scratch{};
  for (int i = 0; i + 1 < iterations; ++i) {
    sweep_forward(graph, scratch);
    sweep_backward(graph, scratch);
  }
  before_.clear();
  for_each_watched(size(), stride_, [&](std::size_t first, std::size_t count) {
    before_.insert(before_.end(), &messages_[first], &messages_[first] + count);
  });
  sweep_forward(graph, scratch);
  read_backward(graph, counts_, raster_.data(), scratch, beliefs);
  const float* before = before_.data();
  for_each_watched(size(), stride_, [&](std::size_t first, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const float change = std::abs(std::sqrt(messages_[first + i]) - std::sqrt(*before++));
      beliefs.largest_message_change = std::max(beliefs.largest_message_change, double{change});
    }
  });
  return beliefs;
}

}  // namespace tofmap
