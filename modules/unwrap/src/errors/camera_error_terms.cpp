// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/camera_error_terms.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

std::vector<std::vector<float>> camera_error_terms(const SurfaceSamples& samples,
                                                   const std::vector<float>& phase_b,
                                                   double reference_amplitude) {
  std::vector<std::vector<float>> terms(CameraErrors::coefficients,
                                        std::vector<float>(samples.size(), 0.0F));
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    terms.front()[i] = 1;
    if (std::isnan(phase_b[i])) continue;
    const std::array<float, 2> base_cosine{std::cos(turn * samples.phase_a[i]),
                                           std::cos(turn * phase_b[i])};
    const std::array<float, 2> base_sine{std::sin(turn * samples.phase_a[i]),
                                         std::sin(turn * phase_b[i])};
    std::array<float, 2> cosine = base_cosine;
    std::array<float, 2> sine = base_sine;
    for (std::size_t k = 1; k <= CameraErrors::harmonics; ++k) {
      for (std::size_t f = 0; f < 2; ++f) {
        terms[4 * k - 3 + 2 * f][i] = cosine[f];
        terms[4 * k - 2 + 2 * f][i] = sine[f];
        const float next = cosine[f] * base_cosine[f] - sine[f] * base_sine[f];
        sine[f] = sine[f] * base_cosine[f] + cosine[f] * base_sine[f];
        cosine[f] = next;
      }
    }
    if (!samples.amplitude_a.empty()) {
      terms.back()[i] =
          std::log10(samples.amplitude_a[i] / static_cast<float>(reference_amplitude));
    }
  }
  return terms;
}

}  // namespace tofmap
