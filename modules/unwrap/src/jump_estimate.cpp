// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump_estimate.hpp"

namespace tofmap {
namespace {

/// f_f, from the reconstruction R̂ of equation 2.
JumpProbabilities frequency_evidence(const DualFrequencyFrame& frame, const BeatLimits& limits,
                                     const UnwrapOptions& options) {
  const ImageF reconstruction =
      reconstruct_cycles(frame.phase_a, nearest_pair_counts(frame, limits));
  return frequency_term(frame.phase_a, reconstruction, options.window_px, options.sigma_cycles);
}

}  // namespace

JumpEstimate estimate_jumps(const DualFrequencyFrame& frame, const BeatLimits& limits,
                            const PhaseNoise& noise, const UnwrapOptions& options) {
  JumpEstimate out;
  const ImageF sigma = phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a);
  out.discontinuity = discontinuity_term(frame.phase_a, sigma, options.sigma_cycles);
  if (unwrap_method(options) == UnwrapMethod::single) {
    constexpr double no_trust = 0;
    out.evidence =
        fuse(out.discontinuity, out.discontinuity, options.trust_discontinuity, no_trust);
  } else {
    out.frequency = frequency_evidence(frame, limits, options);
    out.evidence = fuse(out.discontinuity, out.frequency, options.trust_discontinuity,
                        options.trust_frequency);
  }
  out.beliefs = propagate_jump_beliefs(out.evidence, options.iterations);
  return out;
}

}  // namespace tofmap
