// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/jump/jump_estimate.hpp"

#include "tofmap/unwrap/jump/printed_terms.hpp"

#include <cmath>

namespace tofmap {
namespace {

JumpInputs jump_inputs(const Frame& frame, const PhaseSigma& sigma, const PairLimits& limits,
                       const JumpMethod& method, const UnwrapOptions& options) {
  JumpInputs inputs;
  if (method.has_frequency_term) {
    inputs.pixel_counts = method.has_all_counts
                              ? nearest_pair_counts(frame, limits)
                              : threshold_counts(frame, limits, halfway_threshold_m(limits));
    inputs.reconstruction_cycles = reconstruct_cycles(frame.phases[0], inputs.pixel_counts);
  }
  inputs.noise_cycles = method.has_noise_of_pixels
                            ? sigma.cycles[0]
                            : ImageF::Zero(frame.phases[0].rows(), frame.phases[0].cols());
  inputs.terms = {.sigma_cycles = method.has_sigma_of_image
                                      ? std::sqrt(neighbour_variance_cycles2(frame.phases[0]))
                                      : options.sigma_cycles,
                  .window_px = options.window_px,
                  .trust_discontinuity = options.trust_discontinuity,
                  .trust_frequency = method.has_frequency_term ? options.trust_frequency : 0};
  return inputs;
}

}  // namespace

JumpMethod jump_method(UnwrapMethod method) {
  if (method == UnwrapMethod::paper) return {};
  const bool is_jump = method == UnwrapMethod::jump;
  return {.has_frequency_term = is_jump,
          .has_sigma_of_image = false,
          .has_noise_of_pixels = true,
          .has_all_counts = true,
          .regards_residual = is_jump,
          .schedule = MessageSchedule::together};
}

const JumpEstimate& JumpEstimator::estimate(const Frame& frame, const PhaseSigma& sigma,
                                            const PairLimits& limits, const JumpMethod& method,
                                            const UnwrapOptions& options) {
  jumps_.inputs = jump_inputs(frame, sigma, limits, method, options);
  find_jump_evidence(frame.phases[0], jumps_.inputs.noise_cycles,
                     jumps_.inputs.reconstruction_cycles, jumps_.inputs.terms, jumps_.evidence);
  propagation_.run(jumps_.evidence, options.iterations, jumps_.beliefs, 1, method.schedule);
  return jumps_;
}

}  // namespace tofmap
