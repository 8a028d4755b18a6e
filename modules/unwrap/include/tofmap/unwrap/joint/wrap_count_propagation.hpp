// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>

namespace tofmap {

/// The most likely count of every pixel and what belief propagation thinks of it.
struct WrapCountBeliefs {
  ImageU8 count;
  ImageF probability;            ///< of that count
  ImageF other_probability;      ///< of all other counts together: what probability lacks to 1, and
                                 ///< exact where that is lost in rounding
  ImageU8 runner_up;             ///< the second most likely count
  ImageF runner_up_probability;  ///< its probability; 0 where there is one count only
  int iterations = 0;
  double largest_message_change = 0;  ///< of any element of a message, last sweep back; of a sample
};

/// Tree-reweighted sum-product belief propagation over wrap counts (Wainwright, Jaakkola, Willsky,
/// 'A new class of upper bounds on the log partition function', 2005): on a grid every edge is in
/// half of the spanning trees, so messages m enter with the power 1/2, and beliefs do not get
/// surer by going round in circles. With μ = √m (docs/unwrapping.md, equations 15 and 16):
///
///   belief   b(n) = evidence(n) Π μ(n)
///   message  μ(n')² ∝ Σ_n ψ(n, n') b(n) / μ_back(n)²
///
/// One iteration is one sweep from the top left to the bottom right pixel and one back; each
/// message is built from the newest ones. Buffers persist between calls.
class WrapCountPropagation {
 public:
  WrapCountBeliefs run(const WrapCountModel& model, int iterations);

 private:
  void reset(const WrapCountModel& model);
  void sweep_forward(const WrapCountModel& model, bool is_first);
  void sweep_backward(const WrapCountModel& model);
  void remember_watched(const WrapCountModel& model, bool was_sent);
  void read_backward(const WrapCountModel& model, WrapCountBeliefs& beliefs);

  int rows_ = 0;
  int cols_ = 0;
  int counts_ = 0;
  std::array<std::vector<std::uint16_t>, 2> messages_;  ///< μ² to or from the left, and above
  std::array<std::vector<std::uint16_t>, 2> before_;  ///< what was there before the last iteration
  std::vector<std::uint16_t> ones_;
  std::vector<float> scratch_;
};

}  // namespace tofmap
