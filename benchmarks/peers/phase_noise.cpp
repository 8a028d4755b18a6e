// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/phase_noise.hpp"

#include <cmath>
#include <limits>

namespace tofmap::peers {

double amplitude_of_q(const PhaseNoise& noise, double q) {
  // γ₁ a² + γ₀ a + γ₂ − q = 0, solved without cancellation for small γ₁.
  const double rest = noise.gamma_2 - q;
  const double discriminant = noise.gamma_0 * noise.gamma_0 - 4 * noise.gamma_1 * rest;
  if (!(noise.gamma_0 > 0) || discriminant < 0) return std::numeric_limits<float>::max();
  return -2 * rest / (noise.gamma_0 + std::sqrt(discriminant));
}

}  // namespace tofmap::peers
