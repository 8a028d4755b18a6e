// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/jump_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Evidence and messages are limited to odds from 1 / greatest_odds to greatest_odds, so that sums
/// of their products stay within the range of a float. Without a limit, loops would make beliefs
/// grow with every iteration.
constexpr float greatest_odds = 1e6F;

/// Evidence or message as the odds of configurations −1 and +1 against 0: two numbers instead of
/// three, and no normalisation.
struct Odds {
  float minus;
  float plus;
};

[[gnu::always_inline]] inline Odds operator*(const Odds& a, const Odds& b) {
  return {a.minus * b.minus, a.plus * b.plus};
}

[[gnu::always_inline]] inline float bounded(float odds) {
  const float above = odds > 1 / greatest_odds ? odds : 1 / greatest_odds;
  return above < greatest_odds ? above : greatest_odds;
}

/// The message of a curl node to the jump node whose configuration is i = j + k − l by the
/// zero-curl constraint, from the messages p(j), q(k) and r(l) of the other three jump nodes:
///   μ(i) = Σ_jkl δ(i − (j + k − l)) p(j) q(k) r(l).
/// The sum is over all three indices; the paper prints j twice. It is computed as a product of
/// polynomials: p by q, then by r reversed.
[[gnu::always_inline]] inline Odds curl_message(const Odds& p, const Odds& q, const Odds& r) {
  const float pq_minus_2 = p.minus * q.minus;
  const float pq_minus_1 = p.minus + q.minus;
  const float pq_0 = p.minus * q.plus + 1 + p.plus * q.minus;
  const float pq_plus_1 = p.plus + q.plus;
  const float pq_plus_2 = p.plus * q.plus;
  const float minus = pq_minus_2 * r.minus + pq_minus_1 + pq_0 * r.plus;
  const float none = pq_minus_1 * r.minus + pq_0 + pq_plus_1 * r.plus;
  const float plus = pq_0 * r.minus + pq_plus_1 + pq_plus_2 * r.plus;
  const float scale = 1 / none;
  return {bounded(minus * scale), bounded(plus * scale)};
}

/// The largest change of an element of a message that is normalised to the sum 1.
[[gnu::always_inline]] inline float change_of(const Odds& before, const Odds& after) {
  const float sum_before = 1 + before.minus + before.plus;
  const float sum_after = 1 + after.minus + after.plus;
  const float minus = std::abs(after.minus * sum_before - before.minus * sum_after);
  const float plus = std::abs(after.plus * sum_before - before.plus * sum_after);
  const float none = std::abs(sum_before - sum_after);
  const float side = minus > plus ? minus : plus;
  return (side > none ? side : none) / (sum_before * sum_after);
}

/// The most probable configuration; of equally probable ones 0, then −1.
[[gnu::always_inline]] inline float decided(const Odds& belief) {
  const float side = belief.minus >= belief.plus ? -1.0F : 1.0F;
  const float greater = belief.minus >= belief.plus ? belief.minus : belief.plus;
  return greater > 1 ? side : 0.0F;
}

/// The planes of each diagonal; odds take two of them. For the jump nodes to the right of (s_x) and
/// below (s_y) each pixel, they hold the evidence, NaN where the node is absent, and the latest
/// messages from both curl nodes. Messages from outside of the image remain even odds.
enum Plane {
  evidence_x = 0,
  evidence_y = 2,
  from_above = 4,   ///< to s_x from the curl node above it
  from_below = 6,   ///< to s_x from the curl node below it
  from_left = 8,    ///< to s_y from the curl node left of it
  from_right = 10,  ///< to s_y from the curl node right of it
  plane_count = 12,
};

/// The planes of one diagonal, beginning at some row.
struct Diagonal {
  float* data;
  std::size_t step;

  [[gnu::always_inline]] float* plane(int number) const {
    return data + static_cast<std::size_t>(number) * step;
  }
  [[gnu::always_inline]] Odds odds(Plane of, int row) const {
    return {plane(of)[row], plane(of + 1)[row]};
  }
  [[gnu::always_inline]] void set(Plane of, int row, const Odds& odds) const {
    plane(of)[row] = odds.minus;
    plane(of + 1)[row] = odds.plus;
  }
};

Diagonal diagonal_at(std::vector<float>& planes, const DiagonalLayout& layout, int diagonal,
                     int row) {
  return {planes.data() + layout.place(diagonal, row, plane_count), layout.plane_step(diagonal)};
}

/// The messages from the four jump nodes of a curl node: the evidence of each times the message of
/// its other curl node.
struct CurlInputs {
  Odds top;
  Odds left;
  Odds bottom;
  Odds right;

  /// The inputs of the curl node in row i of diagonal `here`; `next` is the diagonal after it. In
  /// the first iteration no message has been sent backward or up.
  [[gnu::always_inline]] CurlInputs(const Diagonal& here, const Diagonal& next, int i,
                                    bool is_first)
      : top(here.odds(evidence_x, i) * here.odds(from_above, i)),
        left(here.odds(evidence_y, i) * here.odds(from_left, i)),
        bottom(next.odds(evidence_x, i + 1)),
        right(next.odds(evidence_y, i)) {
    if (is_first) return;
    bottom = bottom * next.odds(from_below, i + 1);
    right = right * next.odds(from_right, i);
  }

  /// Whether all four jump nodes are present, so that there is a curl node. A sum avoids branches.
  [[gnu::always_inline]] bool has_curl() const {
    const float sum = top.minus + left.minus + bottom.minus + right.minus;
    return sum == sum;
  }
};

/// The message, or even odds if there is no curl node.
[[gnu::always_inline]] inline Odds if_curl(bool has_curl, const Odds& message) {
  return {has_curl ? message.minus : 1.0F, has_curl ? message.plus : 1.0F};
}

/// Sends the messages forward and down. Each message solves the zero-curl constraint for the jump
/// node that receives it, for example right = bottom + left − top.
template <bool is_first>
[[gnu::always_inline]] inline void send_on(int rows, const Diagonal& here, const Diagonal& next) {
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const CurlInputs in(here, next, i, is_first);
    const bool has_curl = in.has_curl();
    next.set(from_left, i, if_curl(has_curl, curl_message(in.bottom, in.left, in.top)));
    next.set(from_above, i + 1, if_curl(has_curl, curl_message(in.top, in.right, in.left)));
  }
}

TOFMAP_VECTOR_CLONES void send_forward_and_down(int rows, const Diagonal& here,
                                                const Diagonal& next) {
  send_on<false>(rows, Diagonal(here), Diagonal(next));
}

TOFMAP_VECTOR_CLONES void send_first_forward_and_down(int rows, const Diagonal& here,
                                                      const Diagonal& next) {
  send_on<true>(rows, Diagonal(here), Diagonal(next));
}

/// What the backward and up sweeps determine besides messages; each array has an element per row.
struct Findings {
  float* jump_x;             ///< most probable s_x of this diagonal
  float* jump_y;             ///< most probable s_y of this diagonal
  const float* next_jump_x;  ///< most probable s_x of the next diagonal
  const float* next_jump_y;  ///< most probable s_y of the next diagonal
  float* change;             ///< largest change of a message so far
};

/// Sends the messages backward and up. Returns the number of curl nodes whose constraint is
/// violated.
template <bool is_first>
[[gnu::always_inline]] inline int send_back(int rows, const Diagonal& here, const Diagonal& next,
                                            const Findings& findings) {
  int violations = 0;
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    // The next diagonal has already sent its messages of this iteration backward and up.
    const CurlInputs in(here, next, i, false);
    const bool has_curl = in.has_curl();
    const Odds to_left = if_curl(has_curl, curl_message(in.top, in.right, in.bottom));
    const Odds to_top = if_curl(has_curl, curl_message(in.bottom, in.left, in.right));
    const Odds even{1, 1};
    const float change_left = change_of(is_first ? even : here.odds(from_right, i), to_left);
    const float change_top = change_of(is_first ? even : here.odds(from_below, i), to_top);
    const float change = change_left > change_top ? change_left : change_top;
    findings.change[i] = change > findings.change[i] ? change : findings.change[i];
    here.set(from_right, i, to_left);
    here.set(from_below, i, to_top);
    const float jump_x = decided(in.top * to_top);
    const float jump_y = decided(in.left * to_left);
    const float sum = jump_x + findings.next_jump_y[i] - findings.next_jump_x[i + 1] - jump_y;
    violations += has_curl && sum != 0 ? 1 : 0;
    findings.jump_x[i] = jump_x;
    findings.jump_y[i] = jump_y;
  }
  return violations;
}

TOFMAP_VECTOR_CLONES int send_backward_and_up(int rows, const Diagonal& here, const Diagonal& next,
                                              const Findings& findings) {
  return send_back<false>(rows, Diagonal(here), Diagonal(next), Findings(findings));
}

TOFMAP_VECTOR_CLONES int send_first_backward_and_up(int rows, const Diagonal& here,
                                                    const Diagonal& next,
                                                    const Findings& findings) {
  return send_back<true>(rows, Diagonal(here), Diagonal(next), Findings(findings));
}

/// The jump node of a curl node that a message is sent to.
enum class Towards { right, left, top, bottom };

/// Where the message of curl node i to one of its jump nodes is stored.
struct Place {
  const Diagonal& diagonal;
  Plane plane;
  int row;
};

template <Towards to>
[[gnu::always_inline]] inline Place place_of(const Diagonal& here, const Diagonal& next, int i) {
  if constexpr (to == Towards::right) return {next, from_left, i};
  if constexpr (to == Towards::left) return {here, from_right, i};
  if constexpr (to == Towards::top) return {here, from_below, i};
  if constexpr (to == Towards::bottom) return {next, from_above, i + 1};
}

template <Towards to>
[[gnu::always_inline]] inline Odds message(const CurlInputs& in) {
  if constexpr (to == Towards::right) return curl_message(in.bottom, in.left, in.top);
  if constexpr (to == Towards::left) return curl_message(in.top, in.right, in.bottom);
  if constexpr (to == Towards::top) return curl_message(in.bottom, in.left, in.right);
  if constexpr (to == Towards::bottom) return curl_message(in.top, in.right, in.left);
}

/// Sends the messages of one sweep.
template <Towards to>
[[gnu::always_inline]] inline void send_one_way(int rows, const Diagonal& here,
                                                const Diagonal& next, float* changes) {
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const CurlInputs in(here, next, i, false);
    const Odds sent = if_curl(in.has_curl(), message<to>(in));
    const Place place = place_of<to>(here, next, i);
    const float change = change_of(place.diagonal.odds(place.plane, place.row), sent);
    changes[i] = change > changes[i] ? change : changes[i];
    place.diagonal.set(place.plane, place.row, sent);
  }
}

TOFMAP_VECTOR_CLONES void send(Towards to, int rows, const Diagonal& here_, const Diagonal& next_,
                               float* changes) {
  const Diagonal here = here_;
  const Diagonal next = next_;
  switch (to) {
    case Towards::right:
      return send_one_way<Towards::right>(rows, here, next, changes);
    case Towards::left:
      return send_one_way<Towards::left>(rows, here, next, changes);
    case Towards::top:
      return send_one_way<Towards::top>(rows, here, next, changes);
    case Towards::bottom:
      return send_one_way<Towards::bottom>(rows, here, next, changes);
  }
}

/// Sends one message from every curl node, diagonal by diagonal in the direction of the messages.
/// `changes` holds the largest change so far for every row of the image.
void sweep(Towards to, const DiagonalLayout& layout, std::vector<float>& planes,
           std::vector<float>& changes) {
  const bool is_onward = to == Towards::right || to == Towards::bottom;
  const int last = layout.diagonals() - 1;
  for (int k = 0; k <= last; ++k) {
    const int d = is_onward ? k : last - k;
    const int begin = layout.begin(d);
    send(to, DiagonalLayout::whole_vectors(layout.end(d) - begin),
         diagonal_at(planes, layout, d, begin), diagonal_at(planes, layout, d + 1, begin),
         &changes[static_cast<std::size_t>(begin)]);
  }
}

/// Rows that are copied between images and diagonals at a time: few enough for their cache lines to
/// stay in the first-level cache.
constexpr int band_rows = 32;

/// Probabilities of the configurations of jump nodes on one diagonal within a band of rows.
struct Triples {
  std::array<float, band_rows> minus;
  std::array<float, band_rows> none;
  std::array<float, band_rows> plus;
};

/// Converts probabilities to odds. NaN stays NaN; it does not spread, since there is no curl node
/// at an absent jump node.
TOFMAP_VECTOR_CLONES void load_odds(int rows, const Triples& probability, float* minus_odds,
                                    float* plus_odds) {
  const float* minus = probability.minus.data();
  const float* none = probability.none.data();
  const float* plus = probability.plus.data();
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const float scale = 1 / (none[i] > 0 ? none[i] : std::numeric_limits<float>::min());
    const float absent = 0 * none[i];
    minus_odds[i] = bounded(minus[i] * scale) + absent;
    plus_odds[i] = bounded(plus[i] * scale) + absent;
  }
}

/// Equation 8: the normalised product of the evidence and the messages of both curl nodes.
TOFMAP_VECTOR_CLONES void read_probabilities(int rows, const Diagonal& here_, Plane evidence,
                                             Plane one, Plane other, Triples& probability) {
  const Diagonal here = here_;
  float* minus = probability.minus.data();
  float* none = probability.none.data();
  float* plus = probability.plus.data();
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const Odds belief = here.odds(evidence, i) * here.odds(one, i) * here.odds(other, i);
    const float scale = 1 / (1 + belief.minus + belief.plus);
    minus[i] = belief.minus * scale;
    none[i] = scale;
    plus[i] = belief.plus * scale;
  }
}

/// The jump nodes of one diagonal in successive rows.
struct Slant {
  int diagonal;
  int row;             ///< the first row
  int rows;            ///< the number of rows
  Eigen::Index place;  ///< index of the first node in its image
  Eigen::Index step;   ///< from one node to the next in its image
};

/// Calls `visit` for every Slant of an image of `rows` x `cols` jump nodes, band by band.
template <class Visit>
void for_each_slant(Eigen::Index rows, Eigen::Index cols, const Visit& visit) {
  if (rows == 0 || cols == 0) return;  // the camera image has a single row or column
  const auto last_row = static_cast<int>(rows) - 1;
  const auto last_col = static_cast<int>(cols) - 1;
  for (int band = 0; band <= last_row; band += band_rows) {
    const int band_end = std::min(band + band_rows - 1, last_row);
    for (int d = band; d <= band_end + last_col; ++d) {
      const int first = std::max(band, d - last_col);
      const int last = std::min(band_end, d);
      visit(Slant{d, first, last - first + 1, first * cols + d - first, cols - 1});
    }
  }
}

void gather(const Slant& slant, const ImageF& image, std::array<float, band_rows>& values) {
  const float* from = image.data() + slant.place;
  for (int i = 0; i < slant.rows; ++i) values[static_cast<std::size_t>(i)] = from[i * slant.step];
}

void scatter(const Slant& slant, const std::array<float, band_rows>& values, ImageF& image) {
  float* to = image.data() + slant.place;
  for (int i = 0; i < slant.rows; ++i) to[i * slant.step] = values[static_cast<std::size_t>(i)];
}

Image<std::int8_t> most_likely(const std::array<ImageF, 3>& marginal) {
  Image<std::int8_t> configuration(marginal[0].rows(), marginal[0].cols());
  for (Eigen::Index v = 0; v < configuration.rows(); ++v) {
    for (Eigen::Index u = 0; u < configuration.cols(); ++u) {
      const float minus = marginal[0](v, u);
      const float none = marginal[1](v, u);
      const float plus = marginal[2](v, u);
      configuration(v, u) = std::isnan(none)                ? absent_jump
                            : none >= std::max(minus, plus) ? std::int8_t{0}
                            : minus >= plus                 ? std::int8_t{-1}
                                                            : std::int8_t{1};
    }
  }
  return configuration;
}

}  // namespace

void JumpPropagation::load(const JumpProbabilities& evidence) {
  const auto rows = static_cast<int>(evidence.x[0].rows());
  const auto cols = static_cast<int>(evidence.y[0].cols());
  if (layout_.rows() != rows || layout_.cols() != cols) reset(rows, cols);
  Triples probability;
  const auto load_nodes = [&](const std::array<ImageF, 3>& nodes, Plane plane) {
    for_each_slant(nodes[0].rows(), nodes[0].cols(), [&](const Slant& slant) {
      gather(slant, nodes[0], probability.minus);
      gather(slant, nodes[1], probability.none);
      gather(slant, nodes[2], probability.plus);
      const Diagonal here = diagonal_at(planes_, layout_, slant.diagonal, slant.row);
      load_odds(slant.rows, probability, here.plane(plane), here.plane(plane + 1));
    });
  };
  load_nodes(evidence.x, evidence_x);
  load_nodes(evidence.y, evidence_y);
}

/// Resizes the buffers and sets all evidence to absent and all messages to even odds. Messages that
/// no curl node sends remain even.
void JumpPropagation::reset(int rows, int cols) {
  layout_ = DiagonalLayout(rows, cols);
  planes_.assign(layout_.size(plane_count), 1.0F);
  for (int d = -1; d <= layout_.diagonals(); ++d) {
    const Diagonal here = diagonal_at(planes_, layout_, d, layout_.begin(d) - 1);
    for (const Plane plane : {evidence_x, evidence_y}) {
      std::fill(here.plane(plane), here.plane(plane + 2), nan);
    }
  }
  for (std::vector<float>* row : {&change_, &jump_x_, &jump_y_, &next_jump_x_, &next_jump_y_}) {
    row->assign(static_cast<std::size_t>(rows + DiagonalLayout::lanes), 0.0F);
  }
}

void JumpPropagation::sweep_forward_and_down(bool is_first) {
  for (int d = 0; d < layout_.diagonals(); ++d) {
    const int begin = layout_.begin(d);
    const int rows = DiagonalLayout::whole_vectors(layout_.end(d) - begin);
    const Diagonal here = diagonal_at(planes_, layout_, d, begin);
    const Diagonal next = diagonal_at(planes_, layout_, d + 1, begin);
    if (is_first) {
      send_first_forward_and_down(rows, here, next);
    } else {
      send_forward_and_down(rows, here, next);
    }
  }
}

void JumpPropagation::sweep_backward_and_up(bool is_first, JumpBeliefs& beliefs) {
  beliefs.curl_violations = 0;
  std::fill(change_.begin(), change_.end(), 0.0F);
  for (int d = layout_.diagonals() - 1; d >= 0; --d) {
    const auto begin = static_cast<std::size_t>(layout_.begin(d));
    const int row = layout_.begin(d);
    const int rows = DiagonalLayout::whole_vectors(layout_.end(d) - row);
    const Diagonal here = diagonal_at(planes_, layout_, d, row);
    const Diagonal next = diagonal_at(planes_, layout_, d + 1, row);
    const Findings findings{&jump_x_[begin], &jump_y_[begin], &next_jump_x_[begin],
                            &next_jump_y_[begin], &change_[begin]};
    beliefs.curl_violations += is_first ? send_first_backward_and_up(rows, here, next, findings)
                                        : send_backward_and_up(rows, here, next, findings);
    std::swap(jump_x_, next_jump_x_);
    std::swap(jump_y_, next_jump_y_);
  }
  beliefs.largest_message_change = *std::max_element(change_.begin(), change_.end());
}

void JumpPropagation::read(JumpProbabilities& out) {
  for (ImageF& plane : out.x) plane.resize(layout_.rows(), layout_.cols() - 1);
  for (ImageF& plane : out.y) plane.resize(layout_.rows() - 1, layout_.cols());
  Triples probability;
  const auto read_nodes = [&](Plane evidence, Plane one, Plane other,
                              std::array<ImageF, 3>& nodes) {
    for_each_slant(nodes[0].rows(), nodes[0].cols(), [&](const Slant& slant) {
      read_probabilities(slant.rows, diagonal_at(planes_, layout_, slant.diagonal, slant.row),
                         evidence, one, other, probability);
      scatter(slant, probability.minus, nodes[0]);
      scatter(slant, probability.none, nodes[1]);
      scatter(slant, probability.plus, nodes[2]);
    });
  };
  read_nodes(evidence_x, from_above, from_below, out.x);
  read_nodes(evidence_y, from_left, from_right, out.y);
}

void JumpPropagation::iterate_together(bool is_first, JumpBeliefs& beliefs) {
  sweep_forward_and_down(is_first);
  sweep_backward_and_up(is_first, beliefs);
}

/// Sets all messages to even odds.
void JumpPropagation::forget_messages() {
  for (int d = -1; d <= layout_.diagonals(); ++d) {
    const Diagonal here = diagonal_at(planes_, layout_, d, layout_.begin(d) - 1);
    std::fill(here.plane(from_above), here.plane(plane_count), 1.0F);
  }
}

void JumpPropagation::iterate_one_by_one(bool is_first, JumpBeliefs& beliefs) {
  if (is_first) forget_messages();
  std::fill(change_.begin(), change_.end(), 0.0F);
  for (const Towards to : {Towards::right, Towards::left, Towards::top, Towards::bottom}) {
    sweep(to, layout_, planes_, change_);
  }
  beliefs.largest_message_change = *std::max_element(change_.begin(), change_.end());
  read(beliefs.marginals);
  beliefs.curl_violations = count_curl_violations(most_likely_configurations(beliefs.marginals));
}

void JumpPropagation::run(const JumpProbabilities& evidence, int max_iterations,
                          JumpBeliefs& beliefs, int min_iterations, MessageSchedule schedule) {
  load(evidence);
  beliefs.iterations = 0;
  beliefs.converged = false;
  while (beliefs.iterations < max_iterations &&
         (beliefs.iterations < min_iterations || !beliefs.converged)) {
    const bool is_first = beliefs.iterations == 0;
    if (schedule == MessageSchedule::together) {
      iterate_together(is_first, beliefs);
    } else {
      iterate_one_by_one(is_first, beliefs);
    }
    ++beliefs.iterations;
    beliefs.converged = beliefs.curl_violations == 0;
  }
  read(beliefs.marginals);
}

JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations, MessageSchedule schedule) {
  JumpBeliefs beliefs;
  JumpPropagation().run(evidence, max_iterations, beliefs, min_iterations, schedule);
  return beliefs;
}

JumpConfigurations most_likely_configurations(const JumpProbabilities& marginals) {
  return {most_likely(marginals.x), most_likely(marginals.y)};
}

int count_curl_violations(const JumpConfigurations& s) {
  int violations = 0;
  for (Eigen::Index v = 0; v < s.y.rows(); ++v) {
    for (Eigen::Index u = 0; u < s.x.cols(); ++u) {
      const int top = s.x(v, u);
      const int bottom = s.x(v + 1, u);
      const int left = s.y(v, u);
      const int right = s.y(v, u + 1);
      if (std::max({top, bottom, left, right}) == absent_jump) continue;
      violations += top + right - bottom - left != 0;
    }
  }
  return violations;
}

}  // namespace tofmap
