// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/phase_noise.hpp"

#include "fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// 1 / amplitude², the variance of the phase up to the scale; 1 without amplitudes.
float relative_variance(const ImageF& amplitude, Eigen::Index v, Eigen::Index u) {
  if (amplitude.size() == 0) return 1;
  const float a = amplitude(v, u);
  return a > 0 ? 1 / (a * a) : nan;
}

/// Median of values; reorders them.
double median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// A difference of phases, in half a cycle around 0, and its standard deviation up to the scale.
struct Difference {
  float cycles;
  float relative_sigma;
};

/// Pixels in a row or column whose phases are combined with these weights.
struct Stencil {
  int size;
  std::array<float, 3> weights;
};
constexpr Stencil first_difference{2, {-1, 1, 0}};
constexpr Stencil second_difference{3, {1, -2, 1}};

/// Rows from one sampled one to the next: about 16000 differences tell the noise to 1 %.
Eigen::Index sampling_step(const ImageF& phase) {
  constexpr Eigen::Index enough = 8000;
  return std::max<Eigen::Index>(1, phase.size() / enough);
}

void append_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                        Eigen::Index step_row, Eigen::Index step_col,
                        std::vector<Difference>& differences) {
  const Eigen::Index reach = stencil.size - 1;
  const Eigen::Index step = sampling_step(phase);
  for (Eigen::Index v = step / 2; v + reach * step_row < phase.rows(); v += step) {
    for (Eigen::Index u = 0; u + reach * step_col < phase.cols(); ++u) {
      float cycles = 0;
      float variance = 0;
      for (int i = 0; i < stencil.size; ++i) {
        const float weight = stencil.weights[static_cast<std::size_t>(i)];
        cycles += weight * phase(v + i * step_row, u + i * step_col);
        variance +=
            weight * weight * relative_variance(amplitude, v + i * step_row, u + i * step_col);
      }
      if (!std::isfinite(cycles) || !std::isfinite(variance)) continue;
      differences.push_back({to_half_cycle(cycles), std::sqrt(variance)});
    }
  }
}

std::vector<Difference> sample_differences(const ImageF& phase, const ImageF& amplitude,
                                           const Stencil& stencil) {
  std::vector<Difference> differences;
  differences.reserve(static_cast<std::size_t>(2 * phase.size() / sampling_step(phase) + 1));
  append_differences(phase, amplitude, stencil, 0, 1, differences);
  append_differences(phase, amplitude, stencil, 1, 0, differences);
  return differences;
}

/// The scale at which half of the differences lie within their median deviation.
double scale_by_median(const std::vector<Difference>& differences) {
  constexpr double sigma_of_median = 1.4826;  // σ of a normal variate / its median absolute value
  std::vector<float> normalised;
  normalised.reserve(differences.size());
  for (const Difference& d : differences) {
    normalised.push_back(std::abs(d.cycles) / d.relative_sigma);
  }
  return sigma_of_median * median(normalised);
}

/// The scale that explains the mean cosine: E cos 2πd = exp(−2π²σ²) for a normal d, wrapped or not.
double scale_by_cosine(const std::vector<Difference>& differences) {
  constexpr double two_pi = 2 * std::numbers::pi;
  double cosines = 0;
  for (const Difference& d : differences) cosines += std::cos(two_pi * d.cycles);
  const auto expected = [&](double scale) {
    double sum = 0;
    for (const Difference& d : differences) {
      const double sigma = two_pi * scale * d.relative_sigma;
      sum += std::exp(-0.5 * sigma * sigma);
    }
    return sum;
  };
  double low = 0;
  double high = 1 / differences.front().relative_sigma;
  while (expected(high) > std::max(cosines, 1.0)) high *= 2;
  constexpr int bisections = 24;
  for (int i = 0; i < bisections; ++i) {
    const double middle = (low + high) / 2;
    (expected(middle) > cosines ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The quieter half of the differences.
std::vector<Difference> quieter_half(std::vector<Difference> differences) {
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(
      differences.begin(), middle, differences.end(),
      [](const Difference& a, const Difference& b) { return a.relative_sigma < b.relative_sigma; });
  differences.erase(middle, differences.end());
  return differences;
}

double median_relative_sigma(const std::vector<Difference>& differences) {
  std::vector<float> sigmas;
  sigmas.reserve(differences.size());
  for (const Difference& d : differences) sigmas.push_back(d.relative_sigma);
  return median(sigmas);
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
  // What rounding leaves in a second difference of 16-bit phases.
  constexpr double quantisation_cycles = 1 / 65535.0;
  // From here on a normal difference passes half a cycle too often for its median.
  constexpr double wrapping_cycles = 0.2;
  std::vector<Difference> differences = sample_differences(phase, amplitude, second_difference);
  if (differences.size() < enough) return fallback_cycles * median_amplitude(amplitude);
  double relative_sigma = median_relative_sigma(differences);
  double scale = scale_by_median(differences);
  if (scale * relative_sigma > wrapping_cycles) {
    differences = quieter_half(std::move(differences));
    relative_sigma = median_relative_sigma(differences);
    scale = scale_by_median(differences);
    if (scale * relative_sigma > wrapping_cycles) {
      scale = scale_by_cosine(sample_differences(phase, amplitude, first_difference));
    }
  }
  return std::max(scale, quantisation_cycles / relative_sigma);
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
