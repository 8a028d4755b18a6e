// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tofmap {

// The inter-frequency residual is the range of A minus the nearest range that the phase of B allows
// (docs/unwrapping.md, equation 2):
//
//   ρ(n) = (φ_A + n) λ_A − (φ_B + n_B) λ_B,   n_B such that |ρ| ≤ λ_B / 2
//
// The residual is near zero for the right wrap count n of A. All code that compares the two
// frequencies uses the functions below.

/// x minus the nearest whole number, for |x| < 2^30. Contains neither branches nor calls, so that
/// loops over it vectorise.
[[gnu::always_inline]] inline float to_half_cycle(float x) {
  const float half = x < 0 ? -0.5F : 0.5F;
  return x - static_cast<float>(static_cast<std::int32_t>(x + half));
}

/// The inter-frequency residual in cycles of B, −1/2 … 1/2. `cycles_a` is φ_A + n, `ratio` is
/// λ_A / λ_B. The arguments must not be NaN.
[[gnu::always_inline]] inline float frequency_residual_cycles(float cycles_a, float phase_b,
                                                              float ratio) {
  return to_half_cycle(cycles_a * ratio - phase_b);
}

/// The inter-frequency residual in metres, −λ_B/2 … λ_B/2. `cycles_a` is φ_A + n. NaN if either
/// phase is NaN.
double frequency_residual_m(double wavelength_a_m, double wavelength_b_m, double cycles_a,
                            double phase_b);

/// The change of the inter-frequency residual when the wrap count of A increases by `wraps`, in
/// cycles of B, −1/2 … 1/2. `wavelength_ratio` is λ_A / λ_B.
double residual_shift_cycles(double wavelength_ratio, int wraps);

/// The smallest change of the inter-frequency residual between two wrap counts of A that are at
/// most `counts` − 1 apart, in metres. Pairs of counts whose residuals differ by
/// `indistinguishable_cycles` or less are left out, because the two frequencies cannot tell them
/// apart. Returns λ_B if no pair remains, as when λ_A is a multiple of λ_B. As long as noise and
/// systematic errors together stay below half of this step, the right count has the smallest
/// residual.
double residual_step_m(double wavelength_a_m, double wavelength_b_m, int counts);

/// Two wrap counts whose residuals differ by no more than this, in cycles of B, cannot be told
/// apart.
inline constexpr double indistinguishable_cycles = 0.02;

/// If the inter-frequency residual of a pixel exceeds this number of standard deviations, the two
/// frequencies did not measure the same range: the pixel sees two surfaces or has a wrong wrap
/// count.
inline constexpr float residual_agreement_sigmas = 4;

}  // namespace tofmap
