// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/phase_noise.hpp"

#include "fast_math.hpp"
#include "median.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <tofmap/core/median.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Numbers of a row of pixels, and of rows that are combined with it.
using Row = const float*;

/// Differences of phases, in half a cycle around 0, and their standard deviations up to the scale.
struct Differences {
  std::vector<float> cycles;
  std::vector<float> relative_sigma;

  std::size_t size() const { return cycles.size(); }
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

/// The variance of the phase up to the scale, from an amplitude; infinite without light.
[[gnu::always_inline]] inline float relative_variance(float amplitude) {
  const float light = amplitude > 0 ? amplitude : 0.0F;
  return 1 / (light * light);
}

/// Differences between pixels and those one and two steps away. Where anything is missing their
/// standard deviation is not finite.
TOFMAP_VECTOR_CLONES void fill_differences(int count, const std::array<Row, 3>& phase,
                                           const std::array<Row, 3>& amplitude,
                                           const std::array<float, 3>& weights, float* cycles,
                                           float* relative_sigma) {
  const auto [phase_0, phase_1, phase_2] = phase;
  const auto [amplitude_0, amplitude_1, amplitude_2] = amplitude;
  const auto [weight_0, weight_1, weight_2] = weights;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float difference = weight_0 * phase_0[i] + weight_1 * phase_1[i] + weight_2 * phase_2[i];
    const float variance = weight_0 * weight_0 * relative_variance(amplitude_0[i]) +
                           weight_1 * weight_1 * relative_variance(amplitude_1[i]) +
                           weight_2 * weight_2 * relative_variance(amplitude_2[i]);
    const bool is_present = difference == difference;
    cycles[i] = to_half_cycle(is_present ? difference : 0.0F);
    // A sum, unlike a choice, leaves the compiler no branch.
    relative_sigma[i] = std::sqrt(variance) + 0 * difference;
  }
}

void append_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                        Eigen::Index step_row, Eigen::Index step_col, Differences& differences) {
  const Eigen::Index reach = stencil.size - 1;
  const Eigen::Index step = sampling_step(phase);
  const Eigen::Index count = phase.cols() - reach * step_col;
  if (count <= 0) return;
  const std::vector<float> ones(static_cast<std::size_t>(count), 1.0F);
  std::vector<float> cycles(ones.size());
  std::vector<float> relative_sigma(ones.size());
  for (Eigen::Index v = step / 2; v + reach * step_row < phase.rows(); v += step) {
    std::array<Row, 3> phases{};
    std::array<Row, 3> amplitudes{};
    for (Eigen::Index i = 0; i < 3; ++i) {
      // What a short stencil lacks has the weight 0.
      const Eigen::Index k = std::min(i, reach);
      const Eigen::Index place = (v + k * step_row) * phase.cols() + k * step_col;
      phases[static_cast<std::size_t>(i)] = phase.data() + place;
      amplitudes[static_cast<std::size_t>(i)] =
          amplitude.size() > 0 ? amplitude.data() + place : ones.data();
    }
    fill_differences(static_cast<int>(count), phases, amplitudes, stencil.weights, cycles.data(),
                     relative_sigma.data());
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      if (!std::isfinite(relative_sigma[i])) continue;
      differences.cycles.push_back(cycles[i]);
      differences.relative_sigma.push_back(relative_sigma[i]);
    }
  }
}

Differences sample_differences(const ImageF& phase, const ImageF& amplitude,
                               const Stencil& stencil) {
  Differences differences;
  for (auto* numbers : {&differences.cycles, &differences.relative_sigma}) {
    numbers->reserve(static_cast<std::size_t>(2 * phase.size() / sampling_step(phase) + 1));
  }
  append_differences(phase, amplitude, stencil, 0, 1, differences);
  append_differences(phase, amplitude, stencil, 1, 0, differences);
  return differences;
}

/// The scale at which half of the differences lie within their median deviation.
double scale_by_median(const Differences& differences) {
  std::vector<float> normalised(differences.size());
  for (std::size_t i = 0; i < normalised.size(); ++i) {
    normalised[i] = std::abs(differences.cycles[i]) / differences.relative_sigma[i];
  }
  return sigma_of_median_deviation * median_of_positive(normalised);
}

/// The scale that explains the mean cosine: E cos 2πd = exp(−2π²σ²) for a normal d, wrapped or not.
double scale_by_cosine(const Differences& differences) {
  constexpr double two_pi = 2 * std::numbers::pi;
  double cosines = 0;
  for (const float cycles : differences.cycles) cosines += std::cos(two_pi * cycles);
  const auto expected = [&](double scale) {
    double sum = 0;
    for (const float relative_sigma : differences.relative_sigma) {
      const double sigma = two_pi * scale * relative_sigma;
      sum += std::exp(-0.5 * sigma * sigma);
    }
    return sum;
  };
  double low = 0;
  double high = 1 / differences.relative_sigma.front();
  while (expected(high) > std::max(cosines, 1.0)) high *= 2;
  constexpr int bisections = 24;
  for (int i = 0; i < bisections; ++i) {
    const double middle = (low + high) / 2;
    (expected(middle) > cosines ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// The quieter half of the differences.
Differences quieter_half(const Differences& differences) {
  const float median = median_of_positive(differences.relative_sigma);
  Differences quieter;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (!(differences.relative_sigma[i] < median)) continue;
    quieter.cycles.push_back(differences.cycles[i]);
    quieter.relative_sigma.push_back(differences.relative_sigma[i]);
  }
  // Where half of them are as quiet as any, they all are.
  return quieter.size() < differences.size() / 4 ? differences : quieter;
}

double median_amplitude(const ImageF& amplitude) {
  std::vector<float> positive;
  for (const float a : amplitude.reshaped()) {
    if (a > 0) positive.push_back(a);
  }
  return positive.empty() ? 1 : median_of_positive(positive);
}

double noise_scale(const ImageF& phase, const ImageF& amplitude) {
  constexpr std::size_t enough = 16;
  constexpr double fallback_cycles = 0.01;
  // What rounding leaves in a second difference of 16-bit phases.
  constexpr double quantisation_cycles = 1 / 65535.0;
  // From here on a normal difference passes half a cycle too often for its median.
  constexpr double wrapping_cycles = 0.2;
  Differences differences = sample_differences(phase, amplitude, second_difference);
  if (differences.size() < enough) return fallback_cycles * median_amplitude(amplitude);
  double relative_sigma = median_of_positive(differences.relative_sigma);
  double scale = scale_by_median(differences);
  if (scale * relative_sigma > wrapping_cycles) {
    differences = quieter_half(differences);
    relative_sigma = median_of_positive(differences.relative_sigma);
    scale = scale_by_median(differences);
    if (scale * relative_sigma > wrapping_cycles) {
      scale = scale_by_cosine(sample_differences(phase, amplitude, first_difference));
    }
  }
  return std::max(scale, quantisation_cycles / relative_sigma);
}

TOFMAP_VECTOR_CLONES void fill_sigma(int count, Row phase, Row amplitude, float scale,
                                     float* sigma) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float known = scale * std::sqrt(relative_variance(amplitude[i]));
    sigma[i] = phase[i] == phase[i] && amplitude[i] > 0 ? known : nan;
  }
}

}  // namespace

PhaseNoise estimate_phase_noise(const DualFrequencyFrame& frame) {
  return {noise_scale(frame.phase_a, frame.amplitude_a),
          noise_scale(frame.phase_b, frame.amplitude_b)};
}

ImageF phase_sigma_cycles(const ImageF& phase, const ImageF& amplitude, double scale) {
  ImageF sigma(phase.rows(), phase.cols());
  const auto count = static_cast<int>(phase.size());
  if (amplitude.size() == 0) {
    sigma = phase.isNaN().select(
        nan, ImageF::Constant(phase.rows(), phase.cols(), static_cast<float>(scale)));
  } else {
    fill_sigma(count, phase.data(), amplitude.data(), static_cast<float>(scale), sigma.data());
  }
  return sigma;
}

PhaseSigma::PhaseSigma(const DualFrequencyFrame& frame, const PhaseNoise& noise)
    : a_cycles(phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a)),
      b_cycles(phase_sigma_cycles(frame.phase_b, frame.amplitude_b, noise.scale_b)) {}

}  // namespace tofmap
