// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tofmap {

// The inter-frequency residual: by how much A's range exceeds the nearest range that B allows,
//
//   ρ(n) = (φ_A + n) λ_A − (φ_B + n_B) λ_B,   n_B such that |ρ| ≤ λ_B / 2
//
// (docs/unwrapping.md, equation 2). It is near zero for the right wrap count n of A. Everything
// that compares the two frequencies does so by the functions below.

/// x minus the nearest whole number; |x| < 2^30. Without branches and calls, for vector loops.
[[gnu::always_inline]] inline float to_half_cycle(float x) {
  const float half = x < 0 ? -0.5F : 0.5F;
  return x - static_cast<float>(static_cast<std::int32_t>(x + half));
}

/// The residual in cycles of B, −1/2 … 1/2, of `cycles_a` = φ_A + n. `ratio` is λ_A / λ_B. All
/// arguments must be numbers.
[[gnu::always_inline]] inline float frequency_residual_cycles(float cycles_a, float phase_b,
                                                              float ratio) {
  return to_half_cycle(cycles_a * ratio - phase_b);
}

/// The residual in metres; NaN where a phase is.
double frequency_residual_m(double wavelength_a_m, double wavelength_b_m, double cycles_a,
                            double phase_b);

/// By how much one more wrap of A moves the residual, cycles of B, −1/2 … 1/2, times `wraps`.
double residual_shift_cycles(double wavelength_ratio, int wraps);

/// The least change of the residual that another wrap count of A makes, metres, among counts up to
/// `counts` − 1 apart; λ_B if no count makes any (one frequency is a multiple of the other). Counts
/// whose residuals differ by less than `indistinguishable_cycles` cannot be told apart, and do not
/// count. Half of it is what noise and systematic errors together may reach before the residual of
/// a wrong count is the smaller one.
double residual_step_m(double wavelength_a_m, double wavelength_b_m, int counts);
inline constexpr double indistinguishable_cycles = 0.02;

/// Pixels whose residual exceeds so many standard deviations see two surfaces, or have a wrong
/// count: both frequencies do not measure the same range.
inline constexpr float residual_agreement_sigmas = 4;

}  // namespace tofmap
