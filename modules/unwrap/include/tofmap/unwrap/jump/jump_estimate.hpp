// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/errors/phase_noise.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>
#include <tofmap/unwrap/jump/jump_propagation.hpp>

namespace tofmap {

/// The differences between the methods that estimate phase jumps. The default is the method
/// `paper`, that is, Droeschel, Holz, Behnke (IROS 2010) as printed; each field is one departure
/// from it. docs/unwrapping.md measures the benefit of each ('What the departures buy').
struct JumpMethod {
  /// Whether the frequency term f_f of equation 3 is used. False for `single`.
  bool has_frequency_term = true;
  /// Whether σ of equations 1 and 3 is estimated from the image (neighbour_variance_cycles2), not
  /// taken from UnwrapOptions::sigma_cycles.
  bool has_sigma_of_image = true;
  /// Whether the phase noise of both pixels is added to the variance of f_d in equation 1.
  bool has_noise_of_pixels = false;
  /// Whether equation 2 allows all wrap counts within the limits (nearest_pair_counts), not only 0
  /// and 1 (threshold_counts).
  bool has_all_counts = false;
  /// Whether the inter-frequency residual decides which regions are joined and what their absolute
  /// wrap counts are (integrate_jumps_with_residual).
  bool regards_residual = false;
  /// The order of messages in belief propagation.
  MessageSchedule schedule = MessageSchedule::one_by_one;
};

/// The settings of `paper`, `jump` or `single`.
JumpMethod jump_method(UnwrapMethod method);

/// The inputs from which the evidence for phase jumps is computed (find_jump_evidence).
struct JumpInputs {
  ImageU8 pixel_counts;          ///< wrap counts by equation 2 in each pixel; empty for `single`
  ImageF reconstruction_cycles;  ///< R̂ of equation 2; empty for `single`
  ImageF noise_cycles;           ///< phase noise of each pixel; 0 for `paper`
  JumpTerms terms;               ///< parameters of both terms
};

/// The phase jumps of one frame, stage by stage, as figure 7 of the paper shows them.
struct JumpEstimate {
  JumpInputs inputs;
  JumpProbabilities evidence;  ///< equation 4, before belief propagation
  JumpBeliefs beliefs;         ///< after belief propagation
};

/// Estimates the phase jumps of frames: evidence, then belief propagation. The object keeps its
/// buffers between calls.
class JumpEstimator {
 public:
  /// Estimates the phase jumps of a frame whose phases are NaN at both frequencies where either has
  /// no return; `sigma` is the noise of the phases. The result refers to memory of this object and
  /// is valid until the next call.
  const JumpEstimate& estimate(const Frame& frame, const PhaseSigma& sigma,
                               const PairLimits& limits, const JumpMethod& method,
                               const UnwrapOptions& options);

 private:
  JumpPropagation propagation_;
  JumpEstimate jumps_;
};

}  // namespace tofmap
