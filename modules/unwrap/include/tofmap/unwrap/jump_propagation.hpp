// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/diagonal_layout.hpp>
#include <tofmap/unwrap/jump_evidence.hpp>

namespace tofmap {

/// What belief propagation makes of the evidence.
struct JumpBeliefs {
  JumpProbabilities marginals;        ///< absent nodes are NaN, as in the evidence
  int iterations = 0;                 ///< of all four sweeps
  int curl_violations = 0;            ///< curls that the most likely configurations leave
  bool converged = false;             ///< no curl is left
  double largest_message_change = 0;  ///< of any element of a message, last sweeps back and up
};

/// Sum-product belief propagation between jump nodes and curl nodes (sections II.B and II.C).
///
/// A curl node joins the four jump nodes around 2 x 2 pixels and allows only
///   s_x(x, y) + s_y(x+1, y) − s_x(x, y+1) − s_y(x, y) = 0.
/// One iteration is four sweeps: forward along rows together with down along columns, then backward
/// together with up; each sends one message from every curl node, built from the newest messages.
/// Stops as soon as no curl of the most likely configurations is left, or after `max_iterations`,
/// but not before `min_iterations`. Where an absent node takes part there is no curl node.
/// Exact on graphs without loops (one row or column of curls), once evidence has crossed them:
/// two iterations suffice. Buffers persist between calls.
class JumpPropagation {
 public:
  JumpBeliefs run(const JumpProbabilities& evidence, int max_iterations, int min_iterations = 1);

 private:
  /// Numbers of a diagonal and of the one after it, an entry for every row of the image and one
  /// beyond.
  struct Rows {
    std::vector<float> minus, none, plus;  ///< probabilities of nodes
    std::vector<float> change;             ///< of messages, the largest so far
    std::vector<float> x, y, next_x, next_y;  ///< of nodes to the right and down: 1 where there is
                                              ///< one, or the most likely configuration

    explicit Rows(int rows = 0);
    void step_back();  ///< what was of this diagonal is of the next one
  };

  void load(const JumpProbabilities& evidence);
  void sweep_forward_and_down();
  void sweep_backward_and_up(JumpBeliefs& beliefs);
  JumpProbabilities marginals();

  DiagonalLayout layout_;      ///< of pixels; nodes and curls lie where their upper left pixel does
  std::vector<float> planes_;  ///< evidence and messages
  Rows rows_;
};

/// The same, once.
JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations = 1);

/// The most likely configuration of each node, −1, 0 or +1; absent_jump where it is absent.
inline constexpr std::int8_t absent_jump = 127;
struct JumpConfigurations {
  Image<std::int8_t> x;
  Image<std::int8_t> y;
};
JumpConfigurations most_likely_configurations(const JumpProbabilities& marginals);

/// How many curl nodes are not zero; curls with an absent node do not count.
int count_curl_violations(const JumpConfigurations& configurations);

}  // namespace tofmap
