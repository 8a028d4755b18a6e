// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>

namespace tofmap {

/// The most probable wrap count of every pixel and its probability, before calibration.
struct WrapCountBeliefs {
  ImageU8 count;                 ///< the most probable wrap count
  ImageF probability;            ///< of `count`
  ImageF other_probability;      ///< of all other wrap counts together, summed separately: 1 −
                                 ///< probability would round to 0 for the surest pixels
  ImageU8 runner_up;             ///< the second most probable wrap count
  ImageF runner_up_probability;  ///< of `runner_up`; 0 if there is only one wrap count
  int iterations = 0;            ///< iterations of belief propagation
  /// Largest change of a message element between the last two backward sweeps, over a sample of the
  /// messages.
  double largest_message_change = 0;
};

/// Tree-reweighted sum-product belief propagation over wrap counts (Wainwright, Jaakkola, Willsky:
/// A new class of upper bounds on the log partition function, IEEE Trans. Inf. Theory, 2005). On a
/// grid, every edge is in half of the spanning trees, so each message m enters with the power 1/2.
/// This counteracts the overconfidence of plain belief propagation on loops. With μ = √m
/// (docs/unwrapping.md, equations 15 and 16):
///
///   belief   b(n) = evidence(n) Π μ(n)                    μ of all neighbours
///   message  μ(n')² ∝ Σ_n ψ(n, n') b(n) / μ_back(n)²      μ_back: the message along the same edge
///                                                         in the opposite direction
///
/// One iteration is a forward sweep, from the top left to the bottom right pixel, and a backward
/// sweep. Each message is computed from the latest messages. The object keeps its buffers between
/// calls.
class WrapCountPropagation {
 public:
  /// Runs a fixed number of iterations, at least 1. Pixels without a return have values, too: those
  /// that uniform unary factors and no neighbours give.
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
  std::array<std::vector<std::uint16_t>, 2>
      messages_;  ///< μ² along the edge to the left, and above
  std::array<std::vector<std::uint16_t>, 2> before_;  ///< messages before the last iteration
  std::vector<std::uint16_t> ones_;                   ///< stand for messages not yet sent
  std::vector<float> scratch_;
};

}  // namespace tofmap
