// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/common/unwrap_options.hpp>
#include <tofmap/unwrap/errors/phase_noise.hpp>
#include <tofmap/unwrap/jump/jump_evidence.hpp>
#include <tofmap/unwrap/jump/jump_propagation.hpp>

namespace tofmap {

/// What sets the methods of phase jumps apart. By default it is the paper as printed, the method
/// `paper`; each field is one departure from it. docs/unwrapping.md has what each is worth.
struct JumpMethod {
  bool has_frequency_term = true;    ///< f_f; `single` has none
  bool has_sigma_of_image = true;    ///< σ is the image's own, not the option's
  bool has_noise_of_pixels = false;  ///< the variance of f_d grows by the noise of both pixels
  bool has_all_counts = false;       ///< equation 2 for any number of wraps, not for one
  bool regards_residual = false;     ///< regions join and are anchored as both frequencies agree
  MessageSchedule schedule = MessageSchedule::one_by_one;
};

/// That of `paper`, `jump` and `single`.
JumpMethod jump_method(UnwrapMethod method);

/// What the evidence of one frame is made from.
struct JumpInputs {
  ImageU8 pixel_counts;          ///< equation 2, each pixel by itself; empty for `single`
  ImageF reconstruction_cycles;  ///< R̂ of equation 2; empty for `single`
  ImageF noise_cycles;           ///< of each pixel; 0 where the method knows none
  JumpTerms terms;
};

/// Phase jumps of one frame, stage by stage: what figure 7 of the paper shows.
struct JumpEstimate {
  JumpInputs inputs;
  JumpProbabilities evidence;  ///< of both terms, as far as the options trust them
  JumpBeliefs beliefs;         ///< after propagation
};

/// Estimates the phase jumps of frames whose phases are NaN where there is no return. Buffers
/// persist between calls.
class JumpEstimator {
 public:
  /// What it returns is good until the next call.
  const JumpEstimate& estimate(const DualFrequencyFrame& frame, const PhaseSigma& sigma,
                               const UnwrapLimits& limits, const JumpMethod& method,
                               const UnwrapOptions& options);

 private:
  JumpPropagation propagation_;
  JumpEstimate jumps_;
};

}  // namespace tofmap
