// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tofmap {
namespace {

using Planes = std::array<ImageF, 3>;
using Vector3 = std::array<float, 3>;

constexpr float uniform = 1.0F / 3;

/// The least element of a curl node's message. Loops make beliefs grow with every iteration; with
/// messages that reach zero, two that contradict each other would leave 0 / 0. With this floor
/// and that of the evidence (1e-6) no sum of products falls below 1e-27, within a float.
constexpr float least_message = 1e-8F;

Planes uniform_planes(Eigen::Index rows, Eigen::Index cols) {
  const ImageF plane = ImageF::Constant(rows, cols, uniform);
  return {plane, plane, plane};
}

/// The newest message of every curl node to each of its four jump nodes, kept at the jump
/// node. Nodes at the border keep the uniform message on the side that has no curl node.
struct CurlMessages {
  Planes from_above;  ///< to s_x, by the curl node above it
  Planes from_below;
  Planes from_left;  ///< to s_y
  Planes from_right;
};

/// What one propagation works on: evidence with absent nodes made uniform, and which curls are.
struct Graph {
  JumpProbabilities evidence;
  ImageU8 has_curl;  ///< (rows − 1) x (cols − 1) of the pixel image
};

Graph make_graph(const JumpProbabilities& evidence) {
  Graph graph{evidence, ImageU8()};
  const ImageF& x = evidence.x[0];
  const ImageF& y = evidence.y[0];
  graph.has_curl = ImageU8::Zero(y.rows(), x.cols());
  for (Eigen::Index v = 0; v < graph.has_curl.rows(); ++v) {
    for (Eigen::Index u = 0; u < graph.has_curl.cols(); ++u) {
      graph.has_curl(v, u) = !std::isnan(x(v, u)) && !std::isnan(x(v + 1, u)) &&
                             !std::isnan(y(v, u)) && !std::isnan(y(v, u + 1));
    }
  }
  for (Planes* planes : {&graph.evidence.x, &graph.evidence.y}) {
    for (ImageF& plane : *planes) plane = plane.isNaN().select(uniform, plane);
  }
  return graph;
}

/// Message of a jump node to a curl node: its evidence times the message that came from its
/// other curl node. Left unnormalised; the curl's message is normalised.
Vector3 jump_message(const Planes& evidence, const Planes& message, Eigen::Index v,
                     Eigen::Index u) {
  return {evidence[0](v, u) * message[0](v, u), evidence[1](v, u) * message[1](v, u),
          evidence[2](v, u) * message[2](v, u)};
}

/// Message of a curl node to the jump node whose configuration is i = p + q − r by the curl
/// constraint: μ_i = Σ_jkl δ(i − (j + k − l)) p_j q_k r_l, over all three indices (the paper's
/// sum names j twice), as a product of polynomials: first p and q, then r reversed.
Vector3 curl_message(const Vector3& p, const Vector3& q, const Vector3& r) {
  const std::array<float, 5> pq = {p[0] * q[0], p[0] * q[1] + p[1] * q[0],
                                   p[0] * q[2] + p[1] * q[1] + p[2] * q[0],
                                   p[1] * q[2] + p[2] * q[1], p[2] * q[2]};
  const Vector3 message = {pq[0] * r[0] + pq[1] * r[1] + pq[2] * r[2],
                           pq[1] * r[0] + pq[2] * r[1] + pq[3] * r[2],
                           pq[2] * r[0] + pq[3] * r[1] + pq[4] * r[2]};
  const float scale = 1 / (message[0] + message[1] + message[2]);
  return {std::max(message[0] * scale, least_message), std::max(message[1] * scale, least_message),
          std::max(message[2] * scale, least_message)};
}

/// Stores a message and gives its largest change.
float store(Planes& planes, Eigen::Index v, Eigen::Index u, const Vector3& message) {
  float change = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    change = std::max(change, std::abs(message[c] - planes[c](v, u)));
    planes[c](v, u) = message[c];
  }
  return change;
}

/// The four sweeps. Each solves the curl constraint for the jump node it sends to:
/// right = bottom + left − top, and so on.
class Sweeps {
 public:
  explicit Sweeps(const JumpProbabilities& evidence) : graph_(make_graph(evidence)) {
    const Planes x = uniform_planes(evidence.x[0].rows(), evidence.x[0].cols());
    const Planes y = uniform_planes(evidence.y[0].rows(), evidence.y[0].cols());
    messages_ = {x, x, y, y};
  }

  /// All four; returns the largest change of a message.
  float iterate() {
    const Eigen::Index rows = graph_.has_curl.rows();
    const Eigen::Index cols = graph_.has_curl.cols();
    float change = 0;
    const auto each_curl = [&](auto&& send) {
      for (Eigen::Index v = 0; v < rows; ++v) {
        for (Eigen::Index u = 0; u < cols; ++u) change = std::max(change, send(v, u));
      }
    };
    const auto each_curl_back = [&](auto&& send) {
      for (Eigen::Index v = rows - 1; v >= 0; --v) {
        for (Eigen::Index u = cols - 1; u >= 0; --u) change = std::max(change, send(v, u));
      }
    };
    each_curl([&](auto v, auto u) { return forward(v, u); });
    each_curl_back([&](auto v, auto u) { return backward(v, u); });
    each_curl([&](auto v, auto u) { return down(v, u); });
    each_curl_back([&](auto v, auto u) { return up(v, u); });
    return change;
  }

  /// Normalised products of the evidence and both curls' messages; absent nodes are uniform.
  JumpProbabilities marginals() const {
    return {marginal_planes(graph_.evidence.x, messages_.from_above, messages_.from_below),
            marginal_planes(graph_.evidence.y, messages_.from_left, messages_.from_right)};
  }

 private:
  Vector3 top(Eigen::Index v, Eigen::Index u) const {
    return jump_message(graph_.evidence.x, messages_.from_above, v, u);
  }
  Vector3 bottom(Eigen::Index v, Eigen::Index u) const {
    return jump_message(graph_.evidence.x, messages_.from_below, v + 1, u);
  }
  Vector3 left(Eigen::Index v, Eigen::Index u) const {
    return jump_message(graph_.evidence.y, messages_.from_left, v, u);
  }
  Vector3 right(Eigen::Index v, Eigen::Index u) const {
    return jump_message(graph_.evidence.y, messages_.from_right, v, u + 1);
  }

  float forward(Eigen::Index v, Eigen::Index u) {
    if (!graph_.has_curl(v, u)) return 0;
    const Vector3 message = curl_message(bottom(v, u), left(v, u), top(v, u));
    return store(messages_.from_left, v, u + 1, message);
  }
  float backward(Eigen::Index v, Eigen::Index u) {
    if (!graph_.has_curl(v, u)) return 0;
    const Vector3 message = curl_message(top(v, u), right(v, u), bottom(v, u));
    return store(messages_.from_right, v, u, message);
  }
  float down(Eigen::Index v, Eigen::Index u) {
    if (!graph_.has_curl(v, u)) return 0;
    const Vector3 message = curl_message(top(v, u), right(v, u), left(v, u));
    return store(messages_.from_above, v + 1, u, message);
  }
  float up(Eigen::Index v, Eigen::Index u) {
    if (!graph_.has_curl(v, u)) return 0;
    const Vector3 message = curl_message(bottom(v, u), left(v, u), right(v, u));
    return store(messages_.from_below, v, u, message);
  }

  static Planes marginal_planes(const Planes& evidence, const Planes& one, const Planes& other) {
    Planes marginal;
    for (std::size_t c = 0; c < 3; ++c) marginal[c] = evidence[c] * one[c] * other[c];
    const ImageF sum = marginal[0] + marginal[1] + marginal[2];
    for (ImageF& plane : marginal) plane /= sum;
    return marginal;
  }

  Graph graph_;
  CurlMessages messages_;
};

void mark_absent(const Planes& evidence, Planes& marginal) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (ImageF& plane : marginal) plane = evidence[0].isNaN().select(nan, plane);
}

Image<std::int8_t> most_likely(const Planes& marginal) {
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

JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations) {
  Sweeps sweeps(evidence);
  JumpBeliefs beliefs;
  while (beliefs.iterations < max_iterations) {
    beliefs.largest_message_change = sweeps.iterate();
    ++beliefs.iterations;
    if (beliefs.iterations < min_iterations && beliefs.iterations < max_iterations) continue;
    beliefs.marginals = sweeps.marginals();
    mark_absent(evidence.x, beliefs.marginals.x);
    mark_absent(evidence.y, beliefs.marginals.y);
    beliefs.curl_violations = count_curl_violations(most_likely_configurations(beliefs.marginals));
    beliefs.converged = beliefs.curl_violations == 0;
    if (beliefs.converged) break;
  }
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
