// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/jump_evidence.hpp>
#include <tofmap/unwrap/jump_propagation.hpp>
#include <tofmap/unwrap/unwrap_options.hpp>

namespace tofmap {

/// Phase jumps of one frame, stage by stage: what figure 7 of the paper shows.
struct JumpEstimate {
  ImageU8 nearest;             ///< nearest_pair_counts; empty for the method `single`
  JumpProbabilities evidence;  ///< of both terms, as far as the options trust them
  JumpBeliefs beliefs;         ///< after propagation
};

/// The terms that the options ask for; `single` has no frequency term to trust.
JumpTerms jump_terms(const UnwrapOptions& options);

/// Estimates the phase jumps of frames whose phases are NaN where there is no return, for the
/// methods `jump` and `single`. Buffers persist between calls.
class JumpEstimator {
 public:
  /// What it returns is good until the next call.
  const JumpEstimate& estimate(const DualFrequencyFrame& frame, const PhaseSigma& sigma,
                               const BeatLimits& limits, const UnwrapOptions& options);

 private:
  JumpPropagation propagation_;
  JumpEstimate jumps_;
};

}  // namespace tofmap
