// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/errors/phase_noise.hpp"

#include "errors/median.hpp"
#include "errors/phase_differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Phase differences, wrapped to −1/2 … 1/2 cycles, and their standard deviations for a noise scale
/// of 1.
struct Differences {
  std::vector<float> cycles;
  std::vector<float> relative_sigma;

  std::size_t size() const { return cycles.size(); }
};

/// Every n-th row is sampled; returns n. About 16 000 differences in both directions determine the
/// noise to 1 %.
Eigen::Index sampling_step(const ImageF& phase) {
  constexpr Eigen::Index enough = 8000;
  return std::max<Eigen::Index>(1, phase.size() / enough);
}

/// Appends the finite differences of the sampled rows in one direction.
void append_differences(const ImageF& phase, const ImageF& amplitude, const Stencil& stencil,
                        Eigen::Index step_row, Eigen::Index step_col, Differences& differences) {
  const Eigen::Index step = sampling_step(phase);
  std::vector<float> cycles(static_cast<std::size_t>(phase.cols()));
  std::vector<float> relative_sigma(cycles.size());
  for (Eigen::Index v = step / 2; v < phase.rows(); v += step) {
    const int count = find_differences(phase, amplitude, stencil, v, step_row, step_col,
                                       cycles.data(), relative_sigma.data());
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (!std::isfinite(relative_sigma[i])) continue;
      differences.cycles.push_back(cycles[i]);
      differences.relative_sigma.push_back(relative_sigma[i]);
    }
  }
}

/// Differences along the rows and columns of an image.
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

/// The noise scale from the median of the absolute normalised differences.
double scale_by_median(const Differences& differences) {
  std::vector<float> normalised(differences.size());
  for (std::size_t i = 0; i < normalised.size(); ++i) {
    normalised[i] = std::abs(differences.cycles[i]) / differences.relative_sigma[i];
  }
  return sigma_of_median_deviation * median_of_positive(normalised);
}

/// The noise scale that explains the mean cosine of the differences: E cos 2πd = exp(−2π²σ²) if d
/// is normal, whether it is wrapped or not.
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

/// The differences whose predicted noise is below the median; all differences if too few are.
Differences quieter_half(const Differences& differences) {
  const float median = median_of_positive(differences.relative_sigma);
  Differences quieter;
  for (std::size_t i = 0; i < differences.size(); ++i) {
    if (!(differences.relative_sigma[i] < median)) continue;
    quieter.cycles.push_back(differences.cycles[i]);
    quieter.relative_sigma.push_back(differences.relative_sigma[i]);
  }
  // If many differences share the lowest noise, all of them are about equally quiet.
  return quieter.size() < differences.size() / 4 ? differences : quieter;
}

/// Median of the positive amplitudes; 1 if there are none.
double median_amplitude(const ImageF& amplitude) {
  std::vector<float> positive;
  for (const float a : amplitude.reshaped()) {
    if (a > 0) positive.push_back(a);
  }
  return positive.empty() ? 1 : median_of_positive(positive);
}

/// The quantisation step of the phases, in cycles: the smallest difference between phases of a
/// sample of pixels, and at least one step of 16 bits.
double quantisation_step_cycles(const ImageF& phase) {
  constexpr double least_cycles = 1 / 65535.0;
  constexpr double coarsest_cycles = 1 / 16.0;
  constexpr Eigen::Index enough = 400;
  std::vector<float> sample;
  for (Eigen::Index i = 0; i < phase.size(); i += 1 + phase.size() / enough) {
    if (!std::isnan(phase.data()[i])) sample.push_back(phase.data()[i]);
  }
  std::ranges::sort(sample);
  double step = coarsest_cycles;
  for (std::size_t i = 1; i < sample.size(); ++i) {
    const double gap = double{sample[i]} - double{sample[i - 1]};
    if (gap > least_cycles / 2) step = std::min(step, gap);
  }
  return std::max(step, least_cycles);
}

/// The noise scale c of one frequency (tofmap/core/range_error.hpp). `quantisation_cycles` is the
/// quantisation step of its phases.
double noise_scale(const ImageF& phase, const ImageF& amplitude, double quantisation_cycles) {
  constexpr std::size_t enough = 16;
  constexpr double fallback_cycles = 0.01;
  // Above this noise, differences wrap so often that their median is biased.
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

}  // namespace

std::vector<PhaseNoise> estimate_phase_noise(const Frame& frame) {
  std::vector<PhaseNoise> noise;
  const ImageF none;
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    const ImageF& amplitude = frame.has_amplitude() ? frame.amplitudes[f] : none;
    const double step_cycles = quantisation_step_cycles(frame.phases[f]);
    noise.push_back({.scale = noise_scale(frame.phases[f], amplitude, step_cycles),
                     .quantisation_cycles = step_cycles});
  }
  return noise;
}

}  // namespace tofmap
