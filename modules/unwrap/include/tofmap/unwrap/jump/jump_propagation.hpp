// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

/// What belief propagation makes of the evidence.
struct JumpBeliefs {
  JumpProbabilities marginals;        ///< absent nodes are NaN, as in the evidence
  int iterations = 0;                 ///< of all four sweeps
  int curl_violations = 0;            ///< curls that the most likely configurations leave
  bool converged = false;             ///< no curl is left
  double largest_message_change = 0;  ///< of any element of a message; last sweeps back and up
};

/// In which order curl nodes send their messages in one iteration. Every sweep sends one message
/// from every curl node, built from the newest messages.
enum class MessageSchedule {
  one_by_one,  ///< as the paper prints it: forward (to the right), backward, up, down
  together,    ///< forward together with down, then backward together with up
};

/// Sum-product belief propagation between jump nodes and curl nodes (sections II.B and II.C).
///
/// A curl node joins the four jump nodes around 2 x 2 pixels and allows only
///   s_x(x, y) + s_y(x+1, y) − s_x(x, y+1) − s_y(x, y) = 0.
/// One iteration is four sweeps over all curl nodes, in the order of the schedule.
/// Stops as soon as no curl of the most likely configurations is left, or after `max_iterations`,
/// but not before `min_iterations`. Where an absent node takes part there is no curl node.
/// Exact on graphs without loops (one row or column of curls), once evidence has crossed them:
/// two iterations suffice. Buffers persist between calls.
class JumpPropagation {
 public:
  void run(const JumpProbabilities& evidence, int max_iterations, JumpBeliefs& beliefs,
           int min_iterations = 1, MessageSchedule schedule = MessageSchedule::together);

 private:
  void load(const JumpProbabilities& evidence);
  void reset(int rows, int cols);
  void sweep_forward_and_down(bool is_first);
  void sweep_backward_and_up(bool is_first, JumpBeliefs& beliefs);
  void iterate_together(bool is_first, JumpBeliefs& beliefs);
  void forget_messages();
  void iterate_one_by_one(bool is_first, JumpBeliefs& beliefs);
  void read(JumpProbabilities& marginals);

  DiagonalLayout layout_;      ///< of pixels; nodes and curls lie where their upper left pixel does
  std::vector<float> planes_;  ///< evidence and messages
  // For every row of the image, and a vector beyond:
  std::vector<float> change_;  ///< of messages, the largest so far
  std::vector<float> jump_x_;  ///< most likely configurations of nodes to the right on a diagonal,
  std::vector<float> jump_y_;  ///< of those down,
  std::vector<float> next_jump_x_;  ///< and of the diagonal after it
  std::vector<float> next_jump_y_;
};

/// The same, once.
JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations = 1,
                                   MessageSchedule schedule = MessageSchedule::together);

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
