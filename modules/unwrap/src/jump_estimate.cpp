// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_estimate.hpp"

namespace tofmap {
JumpEstimate estimate_jumps(JumpPropagation& propagation, const DualFrequencyFrame& frame,
                            const BeatLimits& limits, const PhaseNoise& noise,
                            const UnwrapOptions& options) {
  JumpEstimate out;
  const ImageF sigma = phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a);
  out.discontinuity = discontinuity_term(frame.phase_a, sigma, options.sigma_cycles);
  if (unwrap_method(options) == UnwrapMethod::single) {
    constexpr double no_trust = 0;
    out.evidence =
        fuse(out.discontinuity, out.discontinuity, options.trust_discontinuity, no_trust);
  } else {
    out.nearest = nearest_pair_counts(frame, limits);
    out.frequency = frequency_term(frame.phase_a, reconstruct_cycles(frame.phase_a, out.nearest),
                                   options.window_px, options.sigma_cycles);
    out.evidence = fuse(out.discontinuity, out.frequency, options.trust_discontinuity,
                        options.trust_frequency);
  }
  out.beliefs = propagation.run(out.evidence, options.iterations);
  return out;
}

JumpEstimate estimate_jumps(const DualFrequencyFrame& frame, const BeatLimits& limits,
                            const PhaseNoise& noise, const UnwrapOptions& options) {
  JumpPropagation propagation;
  return estimate_jumps(propagation, frame, limits, noise, options);
}

}  // namespace tofmap
