// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {

inline constexpr double rad_per_cycle = 2 * std::numbers::pi;

/// The phase and amplitude that a pixel measures.
struct PhaseAndAmplitude {
  float phase_cycles = 0;  ///< in [0, 1), even after rounding to float
  float amplitude = 0;
};

/// Phase and amplitude of a complex signal. Empty if the amplitude rounds to zero. Larger
/// amplitudes than 65535 become 65535.
inline std::optional<PhaseAndAmplitude> measure(const std::complex<double>& signal) {
  constexpr double max_amplitude = 65535;
  const double modulus = std::abs(signal);
  if (modulus < 0.5) return std::nullopt;
  const double cycles = std::arg(signal) / rad_per_cycle;
  const auto wrapped = static_cast<float>(cycles - std::floor(cycles));
  return PhaseAndAmplitude{wrapped < 1 ? wrapped : 0,
                           static_cast<float>(std::min(modulus, max_amplitude))};
}

/// The standard deviation σ_n of the noise of each component of the signal for which the range
/// noise of A is `range_noise_m` on a surface of reflectance 0.5 that faces the camera at 5 m:
/// 2π σ_r / λ_A = σ_n / amplitude (docs/simulator.md, equation 4).
inline double noise_strength(double range_noise_m, const Modulation& modulation) {
  constexpr double reference_amplitude = amplitude_unit * 0.5 / (5.0 * 5.0);
  return reference_amplitude * 2 * std::numbers::pi * range_noise_m / modulation.wavelength_m(0);
}

}  // namespace tofmap
