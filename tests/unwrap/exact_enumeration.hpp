// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap::test {

/// Exact marginals of the jump nodes of a small image, by adding up the probability of every
/// configuration whose curls all vanish. 3^nodes steps: for a dozen nodes at the most.
class ExactMarginals {
 public:
  explicit ExactMarginals(const JumpProbabilities& evidence)
      : evidence_(evidence), marginals_(evidence) {
    for (auto* group : {&marginals_.x, &marginals_.y}) {
      for (ImageF& plane : *group) plane.setZero();
    }
    sums_x_.assign(static_cast<std::size_t>(evidence.x[0].size()), {});
    sums_y_.assign(static_cast<std::size_t>(evidence.y[0].size()), {});
    choice_.assign(sums_x_.size() + sums_y_.size(), 0);
    descend(0, 1);
    normalise(sums_x_, marginals_.x);
    normalise(sums_y_, marginals_.y);
  }

  const JumpProbabilities& marginals() const { return marginals_; }

 private:
  void descend(std::size_t node, double probability) {
    if (node == choice_.size()) {
      if (is_consistent()) add(probability);
      return;
    }
    const bool in_x = node < sums_x_.size();
    const auto& planes = in_x ? evidence_.x : evidence_.y;
    const std::size_t i = in_x ? node : node - sums_x_.size();
    for (int c = 0; c < 3; ++c) {
      choice_[node] = c - 1;
      descend(node + 1, probability * planes[static_cast<std::size_t>(c)].data()[i]);
    }
  }

  int s_x(Eigen::Index v, Eigen::Index u) const {
    return choice_[static_cast<std::size_t>(v * evidence_.x[0].cols() + u)];
  }
  int s_y(Eigen::Index v, Eigen::Index u) const {
    return choice_[sums_x_.size() + static_cast<std::size_t>(v * evidence_.y[0].cols() + u)];
  }

  bool is_consistent() const {
    for (Eigen::Index v = 0; v < evidence_.y[0].rows(); ++v) {
      for (Eigen::Index u = 0; u < evidence_.x[0].cols(); ++u) {
        if (s_x(v, u) + s_y(v, u + 1) - s_x(v + 1, u) - s_y(v, u) != 0) return false;
      }
    }
    return true;
  }

  void add(double probability) {
    for (std::size_t node = 0; node < choice_.size(); ++node) {
      const bool in_x = node < sums_x_.size();
      auto& sum = in_x ? sums_x_[node] : sums_y_[node - sums_x_.size()];
      sum[static_cast<std::size_t>(choice_[node] + 1)] += probability;
    }
  }

  static void normalise(const std::vector<std::array<double, 3>>& sums,
                        std::array<ImageF, 3>& planes) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double total = sums[i][0] + sums[i][1] + sums[i][2];
      for (std::size_t c = 0; c < 3; ++c) {
        planes[c].data()[i] = static_cast<float>(sums[i][c] / total);
      }
    }
  }

  const JumpProbabilities& evidence_;
  JumpProbabilities marginals_;
  std::vector<std::array<double, 3>> sums_x_;
  std::vector<std::array<double, 3>> sums_y_;
  std::vector<int> choice_;
};

}  // namespace tofmap::test
