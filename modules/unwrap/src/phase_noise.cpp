// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/phase_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Weight of a pixel's noise variance relative to scale²: 1 / amplitude².
float relative_variance(const ImageF& amplitude, Eigen::Index row, Eigen::Index col) {
  if (amplitude.size() == 0) return 1;
  const float a = amplitude(row, col);
  return a > 0 ? 1 / (a * a) : nan;
}

/// Median of |values|; reorders them.
double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// |second difference| / its predicted σ for all triples along one direction.
void append_second_differences(const ImageF& phase, const ImageF& amplitude, Eigen::Index step_row,
                               Eigen::Index step_col, std::vector<float>& normalised) {
  for (Eigen::Index v = step_row; v < phase.rows() - step_row; ++v) {
    for (Eigen::Index u = step_col; u < phase.cols() - step_col; ++u) {
      const float d =
          phase(v - step_row, u - step_col) - 2 * phase(v, u) + phase(v + step_row, u + step_col);
      const float variance = relative_variance(amplitude, v - step_row, u - step_col) +
                             4 * relative_variance(amplitude, v, u) +
                             relative_variance(amplitude, v + step_row, u + step_col);
      const float ratio = std::abs(d - std::round(d)) / std::sqrt(variance);
      if (std::isfinite(ratio)) normalised.push_back(ratio);
    }
  }
}

double median_amplitude(const ImageF& amplitude) {
  std::vector<float> positive;
  for (const float a : amplitude.reshaped()) {
    if (a > 0) positive.push_back(a);
  }
  return positive.empty() ? 1 : median(positive);
}

double noise_scale(const ImageF& phase, const ImageF& amplitude) {
  constexpr std::size_t enough = 16;
  constexpr double fallback_cycles = 0.01;
  constexpr double quantisation_cycles = 1 / 65535.0;
  constexpr double sigma_of_median = 1.4826;  // σ of a normal variate / its median absolute value
  std::vector<float> normalised;
  normalised.reserve(static_cast<std::size_t>(2 * phase.size()));
  append_second_differences(phase, amplitude, 0, 1, normalised);
  append_second_differences(phase, amplitude, 1, 0, normalised);
  const double typical_amplitude = median_amplitude(amplitude);
  if (normalised.size() < enough) return fallback_cycles * typical_amplitude;
  return std::max(sigma_of_median * median(normalised), quantisation_cycles * typical_amplitude);
}

}  // namespace

PhaseNoise estimate_phase_noise(const DualFrequencyFrame& frame) {
  return {noise_scale(frame.phase_a, frame.amplitude_a),
          noise_scale(frame.phase_b, frame.amplitude_b)};
}

ImageF phase_sigma_cycles(const ImageF& phase, const ImageF& amplitude, double scale) {
  ImageF sigma(phase.rows(), phase.cols());
  for (Eigen::Index v = 0; v < phase.rows(); ++v) {
    for (Eigen::Index u = 0; u < phase.cols(); ++u) {
      const float one_over_amplitude = std::sqrt(relative_variance(amplitude, v, u));
      sigma(v, u) = std::isnan(phase(v, u)) ? nan : static_cast<float>(scale) * one_over_amplitude;
    }
  }
  return sigma;
}

}  // namespace tofmap
