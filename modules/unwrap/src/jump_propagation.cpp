// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_propagation.hpp"

#include "vector_clones.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Evidence and messages are kept within these odds: loops make beliefs grow with every iteration,
/// and no sum of products may leave the range of a float.
constexpr float greatest_odds = 1e6F;

/// Odds of configurations −1 and +1 against 0. Evidence and messages need no other scale, and two
/// numbers instead of three.
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

/// Message of a curl node to the jump node whose configuration is i = p + q − r by the curl
/// constraint: μ_i = Σ_jkl δ(i − (j + k − l)) p_j q_k r_l, over all three indices (the paper's
/// sum names j twice), as a product of polynomials: first p and q, then r reversed.
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

/// The largest change of an element of a message, of elements that sum to 1.
[[gnu::always_inline]] inline float change_of(const Odds& before, const Odds& after) {
  const float sum_before = 1 + before.minus + before.plus;
  const float sum_after = 1 + after.minus + after.plus;
  const float minus = std::abs(after.minus * sum_before - before.minus * sum_after);
  const float plus = std::abs(after.plus * sum_before - before.plus * sum_after);
  const float none = std::abs(sum_before - sum_after);
  const float side = minus > plus ? minus : plus;
  return (side > none ? side : none) / (sum_before * sum_after);
}

/// The most likely configuration; of equals 0, then −1.
[[gnu::always_inline]] inline float decided(const Odds& belief) {
  const float side = belief.minus >= belief.plus ? -1.0F : 1.0F;
  const float greater = belief.minus >= belief.plus ? belief.minus : belief.plus;
  return greater > 1 ? side : 0.0F;
}

/// What a diagonal has for each of its pixels: evidence of the nodes to the right (x) and down (y),
/// the newest message of every curl node to each of its four jump nodes, kept at the jump node, and
/// whether there is a curl node between the pixel, its right and its lower neighbours (1 or 0).
/// Odds take two planes. Nodes at the border keep even odds on the side that has no curl node.
enum Plane {
  evidence_x = 0,
  from_above = 2,  ///< to s_x, by the curl node above it
  from_below = 4,
  evidence_y = 6,
  from_left = 8,  ///< to s_y
  from_right = 10,
  has_curl = 12,
  plane_count = 13,
};

/// The planes of one diagonal, from some row on.
struct Diagonal {
  float* data;
  std::size_t step;

  [[gnu::always_inline]] Odds odds(Plane plane, int row) const {
    const float* minus = data + static_cast<std::size_t>(plane) * step;
    return {minus[row], minus[row + static_cast<std::ptrdiff_t>(step)]};
  }
  [[gnu::always_inline]] void set(Plane plane, int row, const Odds& odds) const {
    float* minus = data + static_cast<std::size_t>(plane) * step;
    minus[row] = odds.minus;
    minus[row + static_cast<std::ptrdiff_t>(step)] = odds.plus;
  }
  [[gnu::always_inline]] bool curl(int row) const {
    return data[static_cast<std::size_t>(has_curl) * step + static_cast<std::size_t>(row)] > 0;
  }
  /// Messages of a jump node to a curl node: its evidence times the message of its other curl node.
  [[gnu::always_inline]] Odds passed_on(Plane evidence, Plane message, int row) const {
    return odds(evidence, row) * odds(message, row);
  }
};

[[gnu::always_inline]] inline Odds if_curl(bool curl, const Odds& message) {
  return {curl ? message.minus : 1.0F, curl ? message.plus : 1.0F};
}

/// Each message solves the curl constraint for the jump node it goes to: right = bottom + left −
/// top, and so on. `next` is the diagonal after `here`.
TOFMAP_VECTOR_CLONES void send_forward_and_down(int rows, const Diagonal& here_,
                                                const Diagonal& next_) {
  const Diagonal here = here_;
  const Diagonal next = next_;
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const Odds top = here.passed_on(evidence_x, from_above, i);
    const Odds left = here.passed_on(evidence_y, from_left, i);
    const Odds bottom = next.passed_on(evidence_x, from_below, i + 1);
    const Odds right = next.passed_on(evidence_y, from_right, i);
    next.set(from_left, i, if_curl(here.curl(i), curl_message(bottom, left, top)));
    next.set(from_above, i + 1, if_curl(here.curl(i), curl_message(top, right, left)));
  }
}

/// What the sweeps back find out about beliefs. Entries of a pixel's row.
struct Findings {
  float* jump_x;  ///< decided configurations of this diagonal
  float* jump_y;
  const float* next_jump_x;
  const float* next_jump_y;
  float* change;  ///< the largest so far
};

/// Returns how many curl nodes are not zero.
TOFMAP_VECTOR_CLONES int send_backward_and_up(int rows, const Diagonal& here_,
                                              const Diagonal& next_, const Findings& findings_) {
  const Diagonal here = here_;
  const Diagonal next = next_;
  const Findings findings = findings_;
  int violations = 0;
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const bool curl = here.curl(i);
    const Odds top = here.passed_on(evidence_x, from_above, i);
    const Odds left = here.passed_on(evidence_y, from_left, i);
    const Odds bottom = next.passed_on(evidence_x, from_below, i + 1);
    const Odds right = next.passed_on(evidence_y, from_right, i);
    const Odds to_left = if_curl(curl, curl_message(top, right, bottom));
    const Odds to_top = if_curl(curl, curl_message(bottom, left, right));
    const float change_left = change_of(here.odds(from_right, i), to_left);
    const float change_top = change_of(here.odds(from_below, i), to_top);
    const float change = change_left > change_top ? change_left : change_top;
    findings.change[i] = change > findings.change[i] ? change : findings.change[i];
    here.set(from_right, i, to_left);
    here.set(from_below, i, to_top);
    const float jump_x = decided(top * to_top);
    const float jump_y = decided(left * to_left);
    const float sum = jump_x + findings.next_jump_y[i] - findings.next_jump_x[i + 1] - jump_y;
    violations += curl && sum != 0 ? 1 : 0;
    findings.jump_x[i] = jump_x;
    findings.jump_y[i] = jump_y;
  }
  return violations;
}

/// Three numbers a node, from one place on.
struct Triple {
  float* minus;
  float* none;
  float* plus;
};

/// Odds of probabilities, NaN where these are. No curl node is there, so nothing of it spreads.
TOFMAP_VECTOR_CLONES void load_odds(int rows, const Triple& probability, const Diagonal& here_,
                                    Plane evidence, float* present) {
  const Diagonal here = here_;
  const float* minus = probability.minus;
  const float* none = probability.none;
  const float* plus = probability.plus;
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const bool is_present = none[i] == none[i];
    const float scale = 1 / (none[i] > 0 ? none[i] : std::numeric_limits<float>::min());
    here.set(evidence, i,
             {is_present ? bounded(minus[i] * scale) : nan,
              is_present ? bounded(plus[i] * scale) : nan});
    present[i] = is_present ? 1.0F : 0.0F;
  }
}

/// Normalised products of the evidence and both curls' messages.
TOFMAP_VECTOR_CLONES void read_probabilities(int rows, const Diagonal& here_, Plane evidence,
                                             Plane one, Plane other, const Triple& probability) {
  const Diagonal here = here_;
  float* minus = probability.minus;
  float* none = probability.none;
  float* plus = probability.plus;
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) {
    const Odds belief = here.passed_on(evidence, one, i) * here.odds(other, i);
    const float scale = 1 / (1 + belief.minus + belief.plus);
    minus[i] = belief.minus * scale;
    none[i] = scale;
    plus[i] = belief.plus * scale;
  }
}

/// The nodes of an image that are on a diagonal: rows first … last − 1, a step apart in memory.
struct NodesOnDiagonal {
  int first;
  int last;
  Eigen::Index place;
  Eigen::Index step;

  NodesOnDiagonal(const DiagonalLayout& layout, int diagonal, const ImageF& nodes)
      : first(std::max(layout.begin(diagonal), diagonal - static_cast<int>(nodes.cols()) + 1)),
        last(std::min(layout.end(diagonal), static_cast<int>(nodes.rows()))),
        place(first * nodes.cols() + diagonal - first),
        step(nodes.cols() - 1) {}
};

/// Copies the nodes of a diagonal to their rows, and NaN to rows of the diagonal that have none.
void gather(const NodesOnDiagonal& nodes, int begin, int end, const ImageF& image, float* out) {
  std::fill(out + begin, out + end, nan);
  Eigen::Index from = nodes.place;
  for (int row = nodes.first; row < nodes.last; ++row, from += nodes.step) {
    out[row] = image.data()[from];
  }
}

void scatter(const NodesOnDiagonal& nodes, const float* values, ImageF& image) {
  Eigen::Index to = nodes.place;
  for (int row = nodes.first; row < nodes.last; ++row, to += nodes.step) {
    image.data()[to] = values[row];
  }
}

/// Marks the curl nodes of a diagonal: where all four jump nodes are present.
TOFMAP_VECTOR_CLONES void load_curls(int rows, const float* top, const float* left,
                                     const float* bottom, const float* right, float* curls) {
#pragma GCC ivdep
  for (int i = 0; i < rows; ++i) curls[i] = top[i] * left[i] * bottom[i + 1] * right[i];
}

Diagonal diagonal_at(std::vector<float>& planes, const DiagonalLayout& layout, int diagonal,
                     int row) {
  return {planes.data() + layout.place(diagonal, row, plane_count), layout.plane_step(diagonal)};
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

JumpPropagation::Rows::Rows(int rows) {
  for (auto* row : {&minus, &none, &plus, &change, &x, &y, &next_x, &next_y}) {
    row->assign(static_cast<std::size_t>(rows) + 1, 0.0F);
  }
}

void JumpPropagation::Rows::step_back() {
  std::swap(x, next_x);
  std::swap(y, next_y);
}

void JumpPropagation::load(const JumpProbabilities& evidence) {
  const auto rows = static_cast<int>(evidence.x[0].rows());
  const auto cols = static_cast<int>(evidence.y[0].cols());
  if (layout_.rows() != rows || layout_.cols() != cols) {
    layout_ = DiagonalLayout(rows, cols);
    planes_.assign(layout_.size(plane_count), 1.0F);
  }
  rows_ = Rows(rows);
  for (int d = layout_.diagonals() - 1; d >= 0; --d, rows_.step_back()) {
    const int begin = layout_.begin(d);
    const int end = layout_.end(d);
    const Diagonal here = diagonal_at(planes_, layout_, d, begin);
    const auto load_nodes = [&](const std::array<ImageF, 3>& nodes, Plane plane,
                                std::vector<float>& present) {
      const NodesOnDiagonal on(layout_, d, nodes[0]);
      gather(on, begin, end, nodes[0], rows_.minus.data());
      gather(on, begin, end, nodes[1], rows_.none.data());
      gather(on, begin, end, nodes[2], rows_.plus.data());
      load_odds(end - begin, {&rows_.minus[begin], &rows_.none[begin], &rows_.plus[begin]}, here,
                plane, &present[begin]);
    };
    load_nodes(evidence.x, evidence_x, rows_.x);
    load_nodes(evidence.y, evidence_y, rows_.y);
    load_curls(end - begin, &rows_.x[begin], &rows_.y[begin], &rows_.next_x[begin],
               &rows_.next_y[begin], here.data + has_curl * here.step);
    for (const Plane message : {from_above, from_below, from_left, from_right}) {
      for (int i = 0; i < end - begin; ++i) here.set(message, i, {1, 1});
    }
  }
}

void JumpPropagation::sweep_forward_and_down() {
  for (int d = 0; d < layout_.diagonals(); ++d) {
    const int begin = layout_.begin(d);
    send_forward_and_down(layout_.end(d) - begin, diagonal_at(planes_, layout_, d, begin),
                          diagonal_at(planes_, layout_, d + 1, begin));
  }
}

void JumpPropagation::sweep_backward_and_up(JumpBeliefs& beliefs) {
  beliefs.curl_violations = 0;
  std::fill(rows_.change.begin(), rows_.change.end(), 0.0F);
  for (int d = layout_.diagonals() - 1; d >= 0; --d, rows_.step_back()) {
    const int begin = layout_.begin(d);
    beliefs.curl_violations += send_backward_and_up(
        layout_.end(d) - begin, diagonal_at(planes_, layout_, d, begin),
        diagonal_at(planes_, layout_, d + 1, begin),
        {&rows_.x[begin], &rows_.y[begin], &rows_.next_x[begin], &rows_.next_y[begin],
         &rows_.change[begin]});
  }
  beliefs.largest_message_change = *std::max_element(rows_.change.begin(), rows_.change.end());
}

JumpProbabilities JumpPropagation::marginals() {
  JumpProbabilities out;
  for (ImageF& plane : out.x) plane.resize(layout_.rows(), layout_.cols() - 1);
  for (ImageF& plane : out.y) plane.resize(layout_.rows() - 1, layout_.cols());
  for (int d = 0; d < layout_.diagonals(); ++d) {
    const int begin = layout_.begin(d);
    const Diagonal here = diagonal_at(planes_, layout_, d, begin);
    const auto read_nodes = [&](Plane evidence, Plane one, Plane other,
                                std::array<ImageF, 3>& nodes) {
      read_probabilities(layout_.end(d) - begin, here, evidence, one, other,
                         {&rows_.minus[begin], &rows_.none[begin], &rows_.plus[begin]});
      const NodesOnDiagonal on(layout_, d, nodes[0]);
      scatter(on, rows_.minus.data(), nodes[0]);
      scatter(on, rows_.none.data(), nodes[1]);
      scatter(on, rows_.plus.data(), nodes[2]);
    };
    read_nodes(evidence_x, from_above, from_below, out.x);
    read_nodes(evidence_y, from_left, from_right, out.y);
  }
  return out;
}

JumpBeliefs JumpPropagation::run(const JumpProbabilities& evidence, int max_iterations,
                                 int min_iterations) {
  load(evidence);
  JumpBeliefs beliefs;
  while (beliefs.iterations < max_iterations &&
         (beliefs.iterations < min_iterations || !beliefs.converged)) {
    sweep_forward_and_down();
    sweep_backward_and_up(beliefs);
    ++beliefs.iterations;
    beliefs.converged = beliefs.curl_violations == 0;
  }
  beliefs.marginals = marginals();
  return beliefs;
}

JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations) {
  return JumpPropagation().run(evidence, max_iterations, min_iterations);
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
