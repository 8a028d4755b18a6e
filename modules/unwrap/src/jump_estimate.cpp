// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_estimate.hpp"

namespace tofmap {

JumpTerms jump_terms(const UnwrapOptions& options) {
  const bool is_single = unwrap_method(options) == UnwrapMethod::single;
  return {.sigma_cycles = options.sigma_cycles,
          .window_px = options.window_px,
          .trust_discontinuity = options.trust_discontinuity,
          .trust_frequency = is_single ? 0 : options.trust_frequency};
}

const JumpEstimate& JumpEstimator::estimate(const DualFrequencyFrame& frame,
                                            const PhaseSigma& sigma, const BeatLimits& limits,
                                            const UnwrapOptions& options) {
  ImageF reconstruction_cycles;
  if (unwrap_method(options) != UnwrapMethod::single) {
    jumps_.nearest = nearest_pair_counts(frame, limits);
    reconstruction_cycles = reconstruct_cycles(frame.phase_a, jumps_.nearest);
  }
  find_jump_evidence(frame.phase_a, sigma.a_cycles, reconstruction_cycles, jump_terms(options),
                     jumps_.evidence);
  propagation_.run(jumps_.evidence, options.iterations, jumps_.beliefs);
  return jumps_;
}

}  // namespace tofmap
