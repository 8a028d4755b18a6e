// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap::test {

/// Belief propagation as sections II.B and II.C print it, message by message: forward, backward,
/// up, down. Every node must be there.
class PlainJumpPropagation {
 public:
  explicit PlainJumpPropagation(const JumpProbabilities& evidence)
      : evidence_(evidence),
        rows_(evidence.x[0].rows()),
        cols_(evidence.y[0].cols()),
        to_right_(static_cast<std::size_t>(rows_ * cols_), Message{1, 1, 1}),
        to_left_(to_right_),
        to_top_(to_right_),
        to_bottom_(to_right_) {}

  void iterate() {
    for (Eigen::Index u = 0; u + 1 < cols_; ++u) {  // forward
      for (Eigen::Index v = 0; v + 1 < rows_; ++v) {
        to_right_[at(v, u)] = curl_message(from_bottom(v, u), from_left(v, u), from_top(v, u));
      }
    }
    for (Eigen::Index u = cols_ - 2; u >= 0; --u) {  // backward
      for (Eigen::Index v = 0; v + 1 < rows_; ++v) {
        to_left_[at(v, u)] = curl_message(from_top(v, u), from_right(v, u), from_bottom(v, u));
      }
    }
    for (Eigen::Index v = rows_ - 2; v >= 0; --v) {  // up
      for (Eigen::Index u = 0; u + 1 < cols_; ++u) {
        to_top_[at(v, u)] = curl_message(from_bottom(v, u), from_left(v, u), from_right(v, u));
      }
    }
    for (Eigen::Index v = 0; v + 1 < rows_; ++v) {  // down
      for (Eigen::Index u = 0; u + 1 < cols_; ++u) {
        to_bottom_[at(v, u)] = curl_message(from_top(v, u), from_right(v, u), from_left(v, u));
      }
    }
  }

  JumpProbabilities marginals() const {
    JumpProbabilities out = evidence_;
    const auto read = [](std::array<ImageF, 3>& planes, Eigen::Index v, Eigen::Index u,
                         const Message& belief) {
      for (std::size_t c = 0; c < 3; ++c) planes[c](v, u) = static_cast<float>(belief[c]);
    };
    for (Eigen::Index v = 0; v < rows_; ++v) {
      for (Eigen::Index u = 0; u < cols_; ++u) {
        if (u + 1 < cols_) read(out.x, v, u, product(of_x(v, u), below(v, u), above(v, u)));
        if (v + 1 < rows_) read(out.y, v, u, product(of_y(v, u), right_of(v, u), left_of(v, u)));
      }
    }
    return out;
  }

 private:
  using Message = std::array<double, 3>;
  static constexpr Message even{1, 1, 1};

  std::size_t at(Eigen::Index v, Eigen::Index u) const {
    return static_cast<std::size_t>(v * cols_ + u);
  }

  /// Σ_j Σ_k Σ_l δ(i − (j + k − l)) p_j q_k r_l, normalised.
  static Message curl_message(const Message& p, const Message& q, const Message& r) {
    Message sum{};
    for (int j = -1; j <= 1; ++j) {
      for (int k = -1; k <= 1; ++k) {
        for (int l = -1; l <= 1; ++l) {
          const int i = j + k - l;
          if (i < -1 || i > 1) continue;
          sum[static_cast<std::size_t>(i + 1)] += p[static_cast<std::size_t>(j + 1)] *
                                                  q[static_cast<std::size_t>(k + 1)] *
                                                  r[static_cast<std::size_t>(l + 1)];
        }
      }
    }
    return product(sum, even, even);
  }

  static Message product(const Message& a, const Message& b, const Message& c) {
    Message out{};
    for (std::size_t i = 0; i < 3; ++i) out[i] = a[i] * b[i] * c[i];
    const double sum = out[0] + out[1] + out[2];
    for (double& element : out) element /= sum;
    return out;
  }

  static Message node(const std::array<ImageF, 3>& planes, Eigen::Index v, Eigen::Index u) {
    return {planes[0](v, u), planes[1](v, u), planes[2](v, u)};
  }
  Message of_x(Eigen::Index v, Eigen::Index u) const { return node(evidence_.x, v, u); }
  Message of_y(Eigen::Index v, Eigen::Index u) const { return node(evidence_.y, v, u); }

  // What a jump node got from the curl nodes on both its sides; nothing beyond the border.
  Message above(Eigen::Index v, Eigen::Index u) const {
    return v > 0 ? to_bottom_[at(v - 1, u)] : even;
  }
  Message below(Eigen::Index v, Eigen::Index u) const {
    return v + 1 < rows_ ? to_top_[at(v, u)] : even;
  }
  Message left_of(Eigen::Index v, Eigen::Index u) const {
    return u > 0 ? to_right_[at(v, u - 1)] : even;
  }
  Message right_of(Eigen::Index v, Eigen::Index u) const {
    return u + 1 < cols_ ? to_left_[at(v, u)] : even;
  }

  // What the jump nodes around curl node (v, u) send it: evidence times the other curl's message.
  Message from_top(Eigen::Index v, Eigen::Index u) const {
    return product(of_x(v, u), above(v, u), even);
  }
  Message from_bottom(Eigen::Index v, Eigen::Index u) const {
    return product(of_x(v + 1, u), below(v + 1, u), even);
  }
  Message from_left(Eigen::Index v, Eigen::Index u) const {
    return product(of_y(v, u), left_of(v, u), even);
  }
  Message from_right(Eigen::Index v, Eigen::Index u) const {
    return product(of_y(v, u + 1), right_of(v, u + 1), even);
  }

  const JumpProbabilities& evidence_;
  Eigen::Index rows_;
  Eigen::Index cols_;
  std::vector<Message> to_right_;  ///< of each curl node, at its upper left pixel
  std::vector<Message> to_left_;
  std::vector<Message> to_top_;
  std::vector<Message> to_bottom_;
};

}  // namespace tofmap::test
