// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace tofmap::peers {

/// asin(u) for 0 ≤ u ≤ 1, with an absolute error of at most 3e-7 (Abramowitz and Stegun, equation
/// 4.4.46).
[[gnu::always_inline]] inline float arc_sine(float u) {
  const float series =
      1.5707963050F +
      u * (-0.2145988016F +
           u * (0.0889789874F +
                u * (-0.0501743046F +
                     u * (0.0308918810F +
                          u * (-0.0170881256F + u * (0.0066700901F - u * 0.0012624911F))))));
  return 1.57079633F - std::sqrt(1 - u) * series;
}

/// Standard deviation of a phase, predicted from its amplitude a (Järemo Lawin et al. 2016,
/// section 3.3):
///
///   q(a) = γ₀ a + γ₁ a² + γ₂,   σ = atan √(1 / (q² − 1)) = asin(1 / |q|)   for a > a₁, |q| > 1
///
/// a₁ is the amplitude of q(a₁) = 1. Up to it, σ is π/2; beyond, it is at most π/2 · a₁ / a, which
/// matters where γ₁ < 0 makes |q| small at large amplitudes. With γ₁ = γ₂ = 0, σ is 1 / (γ₀ a) for
/// small noise.
struct PhaseNoise {
  double gamma_0;
  double gamma_1;
  double gamma_2;
};

/// The coefficients that the authors fitted to a Kinect v2, in the unit of libfreenect2's
/// amplitudes (opencl_kde_depth_packet_processor.cl), for 80, 16 and 120 MHz.
inline constexpr std::array<PhaseNoise, 3> kinect_v2_noise{{
    {0.8211288451, -0.002601348899, -3.549793908},
    {1.259642407, -0.005478390508, -4.335841127},
    {0.6447928035, -0.0009627273649, -3.368205575},
}};

inline constexpr float smallest_sigma_rad = 0.001F;

/// The smallest amplitude with this q(a); the largest float if there is none.
double amplitude_of_q(const PhaseNoise& noise, double q);

/// σ in radians of one amplitude. `unit` is amplitude_of_q(1).
[[gnu::always_inline]] inline float phase_sigma_rad(float amplitude, float gamma_0, float gamma_1,
                                                    float gamma_2, float unit) {
  constexpr float quarter_turn = std::numbers::pi_v<float> / 2;
  const float q = std::fabs(gamma_2 + amplitude * (gamma_0 + amplitude * gamma_1));
  const float beyond = quarter_turn * unit / (amplitude > unit ? amplitude : unit);
  const float sine = 1 / (q > 1 ? q : 1.0F);
  const float model = arc_sine(amplitude > unit ? sine : 1.0F);
  const float sigma = model < beyond ? model : beyond;
  return sigma < smallest_sigma_rad ? smallest_sigma_rad : sigma;
}

}  // namespace tofmap::peers
