// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <tofmap/unwrap/joint/wrap_count_model.hpp>

namespace tofmap::test {

/// The grid of factors of a count model, pixel by pixel in doubles.
struct PlainWrapCountModel {
  int rows = 0;
  int cols = 0;
  int counts = 0;
  std::vector<std::vector<double>> evidence;  ///< of a pixel, by count
  std::vector<std::array<double, 3>> right;   ///< ψ of a step of −1, 0, +1, by left pixel
  std::vector<std::array<double, 3>> down;    ///< by upper pixel

  explicit PlainWrapCountModel(const WrapCountModel& model)
      : rows(model.layout().rows()), cols(model.layout().cols()), counts(model.counts()) {
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        evidence.push_back(model.evidence_of(v, u));
        right.push_back(steps(model, model.right(), v, u));
        down.push_back(steps(model, model.down(), v, u));
      }
    }
  }

  /// ψ(n, n') of an edge, n' − n = step.
  static double factor(const std::array<double, 3>& edge, int step) {
    return std::abs(step) > 1 ? 1 : edge[static_cast<std::size_t>(step + 1)];
  }

 private:
  static std::array<double, 3> steps(const WrapCountModel& model,
                                     const WrapCountModel::Edges& edges, int v, int u) {
    const std::size_t at = model.layout().place(u + v, v, 1);
    const double next = edges.next[at];
    return {1 + std::max(-next, 0.0), 1.0 + edges.same[at], 1 + std::max(next, 0.0)};
  }
};

/// The marginals of tree-reweighted belief propagation, as the equations say it: no vectors, no
/// diagonals, doubles.
class PlainWrapCountPropagation {
 public:
  explicit PlainWrapCountPropagation(const PlainWrapCountModel& model)
      : model_(model),
        messages_(4, std::vector<std::vector<double>>(
                         model.evidence.size(),
                         std::vector<double>(static_cast<std::size_t>(model.counts), 1.0))) {}

  std::vector<std::vector<double>> run(int iterations) {
    for (int i = 0; i < iterations; ++i) {
      for (int v = 0; v < model_.rows; ++v) {
        for (int u = 0; u < model_.cols; ++u) {
          if (u + 1 < model_.cols) send(index(v, u), index(v, u + 1), from_left);
          if (v + 1 < model_.rows) send(index(v, u), index(v + 1, u), from_above);
        }
      }
      for (int v = model_.rows - 1; v >= 0; --v) {
        for (int u = model_.cols - 1; u >= 0; --u) {
          if (u > 0) send(index(v, u), index(v, u - 1), from_right);
          if (v > 0) send(index(v, u), index(v - 1, u), from_below);
        }
      }
    }
    std::vector<std::vector<double>> marginals;
    for (std::size_t p = 0; p < model_.evidence.size(); ++p) marginals.push_back(belief(p));
    return marginals;
  }

 private:
  enum From : std::size_t { from_left, from_right, from_above, from_below };

  std::size_t index(int v, int u) const { return static_cast<std::size_t>(v * model_.cols + u); }

  std::vector<double> belief(std::size_t p) const {
    std::vector<double> b(static_cast<std::size_t>(model_.counts));
    double sum = 0;
    for (std::size_t n = 0; n < b.size(); ++n) {
      b[n] = model_.evidence[p][n];
      for (const auto& message : messages_) b[n] *= std::sqrt(message[p][n]);
      sum += b[n];
    }
    for (double& value : b) value /= sum;
    return b;
  }

  void send(std::size_t p, std::size_t q, From from) {
    constexpr std::array<From, 4> opposite{from_right, from_left, from_below, from_above};
    const bool forward = from == from_left || from == from_above;
    const bool along_row = from == from_left || from == from_right;
    const auto& edge = (along_row ? model_.right : model_.down)[forward ? p : q];
    const std::vector<double> b = belief(p);
    std::vector<double> message(b.size(), 0);
    double largest = 0;
    for (std::size_t to = 0; to < b.size(); ++to) {
      for (std::size_t n = 0; n < b.size(); ++n) {
        const int step = static_cast<int>(to) - static_cast<int>(n);
        message[to] += PlainWrapCountModel::factor(edge, forward ? step : -step) * b[n] /
                       messages_[opposite[from]][p][n];
      }
      largest = std::max(largest, message[to]);
    }
    for (double& value : message) value /= largest;
    messages_[from][q] = message;
  }

  const PlainWrapCountModel& model_;
  std::vector<std::vector<std::vector<double>>> messages_;
};

/// Exact marginals of a small grid: the sum over all assignments of counts.
inline std::vector<std::vector<double>> exact_marginals(const PlainWrapCountModel& model) {
  const std::size_t pixels = model.evidence.size();
  const auto counts = static_cast<std::size_t>(model.counts);
  std::vector<std::vector<double>> sums(pixels, std::vector<double>(counts, 0));
  std::vector<std::size_t> assigned(pixels, 0);
  double total = 0;
  for (bool has_more = true; has_more;) {
    double probability = 1;
    for (std::size_t p = 0; p < pixels; ++p) {
      const int n = static_cast<int>(assigned[p]);
      const int col = static_cast<int>(p) % model.cols;
      const int row = static_cast<int>(p) / model.cols;
      probability *= model.evidence[p][assigned[p]];
      if (col + 1 < model.cols) {
        const int step = static_cast<int>(assigned[p + 1]) - n;
        probability *= PlainWrapCountModel::factor(model.right[p], step);
      }
      if (row + 1 < model.rows) {
        const int step = static_cast<int>(assigned[p + static_cast<std::size_t>(model.cols)]) - n;
        probability *= PlainWrapCountModel::factor(model.down[p], step);
      }
    }
    total += probability;
    for (std::size_t p = 0; p < pixels; ++p) sums[p][assigned[p]] += probability;
    has_more = false;
    for (std::size_t& digit : assigned) {
      if (++digit < counts) {
        has_more = true;
        break;
      }
      digit = 0;
    }
  }
  for (auto& marginal : sums) {
    for (double& value : marginal) value /= total;
  }
  return sums;
}

}  // namespace tofmap::test
