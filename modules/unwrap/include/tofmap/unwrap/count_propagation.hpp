// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/count_model.hpp>

namespace tofmap {

/// The most likely count of every pixel and what belief propagation thinks of it.
struct CountBeliefs {
  ImageU8 count;
  ImageF probability;        ///< of that count
  ImageU8 rival;             ///< the second most likely count
  ImageF rival_probability;  ///< its probability; 0 where there is one count only
  int iterations = 0;
  double largest_message_change = 0;  ///< of any element of a message, last sweep back
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
class CountPropagation {
 public:
  CountBeliefs run(const CountModel& model, int iterations);

 private:
  void reset(const CountModel& model);
  void clear(const CountModel& model, int from, int row, int col);
  void sweep_forward(const CountModel& model, bool is_first);
  void sweep_backward(const CountModel& model, CountBeliefs* beliefs);

  std::array<std::vector<std::uint16_t>, 4> messages_;  ///< μ from left, right, above, below
  std::vector<std::uint16_t> ones_;
  std::vector<float> scratch_;
};

}  // namespace tofmap
