// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>

namespace tofmap {

/// The result of belief propagation over phase jumps.
struct JumpBeliefs {
  /// Probabilities after propagation; absent nodes are NaN, as in the evidence.
  JumpProbabilities marginals;
  /// Iterations made; one iteration is four sweeps.
  int iterations = 0;
  /// Curl nodes whose constraint the most probable configurations violate.
  int curl_violations = 0;
  /// Whether curl_violations is 0.
  bool converged = false;
  /// Largest change of a message element in the last iteration: by all four sweeps for
  /// MessageSchedule::one_by_one, by the backward and up sweeps for `together`.
  double largest_message_change = 0;
};

/// The order in which curl nodes send their messages within one iteration. In each sweep, every
/// curl node sends one message, which is computed from the latest messages.
enum class MessageSchedule {
  one_by_one,  ///< as the paper prints it: forward (to the right), backward, up, down
  together,    ///< forward together with down, then backward together with up
};

/// Sum-product belief propagation between jump nodes and curl nodes (Droeschel, Holz, Behnke, IROS
/// 2010, sections II.B and II.C; docs/unwrapping.md, equations 5 to 8).
///
/// A curl node connects the four jump nodes of a loop of 2 x 2 pixels and enforces the zero-curl
/// constraint
///
///   s_x(x, y) + s_y(x+1, y) − s_x(x, y+1) − s_y(x, y) = 0.
///
/// A loop with an absent jump node has no curl node. Propagation is exact on graphs without loops
/// (a single row or column of curl nodes) after two iterations. The object keeps its buffers
/// between calls.
class JumpPropagation {
 public:
  /// Propagates `evidence` and writes the result into `beliefs`. One iteration is four sweeps over
  /// all curl nodes in the order of `schedule`. Stops when the most probable configurations violate
  /// no constraint and `min_iterations` are done, and at the latest after `max_iterations`, at
  /// least 1.
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

  DiagonalLayout layout_;  ///< of pixels; jump and curl nodes are stored at their upper left pixel
  std::vector<float> planes_;  ///< evidence and messages
  // One element for every row of the image, padded by one vector:
  std::vector<float> change_;       ///< largest change of a message so far
  std::vector<float> jump_x_;       ///< most probable s_x of the current diagonal
  std::vector<float> jump_y_;       ///< most probable s_y of the current diagonal
  std::vector<float> next_jump_x_;  ///< most probable s_x of the next diagonal
  std::vector<float> next_jump_y_;  ///< most probable s_y of the next diagonal
};

/// Runs JumpPropagation with buffers of its own.
JumpBeliefs propagate_jump_beliefs(const JumpProbabilities& evidence, int max_iterations,
                                   int min_iterations = 1,
                                   MessageSchedule schedule = MessageSchedule::together);

/// The value of absent nodes in JumpConfigurations.
inline constexpr std::int8_t absent_jump = 127;

/// A configuration, −1, 0 or +1, for each jump node; absent_jump for absent nodes. The images have
/// the sizes of those in JumpProbabilities.
struct JumpConfigurations {
  Image<std::int8_t> x;
  Image<std::int8_t> y;
};

/// The most probable configuration of each node; of equally probable ones 0, then −1.
JumpConfigurations most_likely_configurations(const JumpProbabilities& marginals);

/// The number of loops of 2 x 2 pixels that violate the zero-curl constraint. Loops with an absent
/// node are not counted.
int count_curl_violations(const JumpConfigurations& configurations);

}  // namespace tofmap
