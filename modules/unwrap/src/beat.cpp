// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/beat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <tofmap/core/error.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr double noise_tolerance_cycles = 0.05;

}  // namespace

BeatLimits beat_limits(const SensorModel& sensor, double max_range_m) {
  BeatLimits limits;
  limits.wavelength_a_m = sensor.modulation.wavelength_a_m();
  limits.wavelength_b_m = sensor.modulation.wavelength_b_m();
  limits.max_range_m = max_range_m > 0 ? max_range_m
                       : sensor.max_range_m > 0
                           ? sensor.max_range_m
                           : combined_range_m(sensor.modulation, noise_tolerance_cycles);
  limits.count_a = wrap_limits(sensor.modulation, limits.max_range_m).count_a;
  if (limits.count_a > invalid_wrap_count) {
    throw UsageError("max_range_m: " + std::to_string(limits.max_range_m) + " m takes " +
                     std::to_string(limits.count_a) + " wrap counts; allowed: at most 255, i.e. " +
                     std::to_string(invalid_wrap_count * limits.wavelength_a_m) + " m");
  }
  return limits;
}

float beat_residual_m(const BeatLimits& limits, float phase_a, float phase_b, int n_a) {
  const auto range_a_m = static_cast<float>((phase_a + n_a) * limits.wavelength_a_m);
  const auto wavelength_b_m = static_cast<float>(limits.wavelength_b_m);
  const float cycles_b = range_a_m / wavelength_b_m - phase_b;
  return (cycles_b - std::round(cycles_b)) * wavelength_b_m;
}

bool count_within_limits(const BeatLimits& limits, float phase_a, int n_a) {
  if (n_a == 0) return true;
  const double range_m = (phase_a + n_a) * limits.wavelength_a_m;
  return n_a < limits.count_a &&
         range_m <= limits.max_range_m + noise_tolerance_cycles * limits.wavelength_a_m;
}

bool can_tell_apart(const BeatLimits& limits, int n_a, int other_n_a) {
  const double cycles_b = (n_a - other_n_a) * limits.wavelength_a_m / limits.wavelength_b_m;
  return std::abs(cycles_b - std::round(cycles_b)) > noise_tolerance_cycles;
}

ImageU8 nearest_pair_counts(const DualFrequencyFrame& frame, const BeatLimits& limits) {
  ImageU8 counts =
      ImageU8::Constant(frame.phase_a.rows(), frame.phase_a.cols(), invalid_wrap_count);
  for (Eigen::Index v = 0; v < counts.rows(); ++v) {
    for (Eigen::Index u = 0; u < counts.cols(); ++u) {
      const float a = frame.phase_a(v, u);
      const float b = frame.phase_b(v, u);
      if (std::isnan(a) || std::isnan(b)) continue;
      float least_m = std::numeric_limits<float>::infinity();
      for (int n = 0; n < limits.count_a && count_within_limits(limits, a, n); ++n) {
        const float residual_m = std::abs(beat_residual_m(limits, a, b, n));
        if (residual_m < least_m) {
          least_m = residual_m;
          counts(v, u) = static_cast<std::uint8_t>(n);
        }
      }
    }
  }
  return counts;
}

ImageF reconstruct_cycles(const ImageF& phase_a, const ImageU8& counts) {
  return (counts == invalid_wrap_count).select(nan, phase_a + counts.cast<float>());
}

BeatCost::BeatCost(const DualFrequencyFrame& frame, const BeatLimits& limits,
                   const PhaseNoise& noise)
    : frame_(frame), limits_(limits) {
  const ImageF sigma_a = phase_sigma_cycles(frame.phase_a, frame.amplitude_a, noise.scale_a) *
                         static_cast<float>(limits.wavelength_a_m);
  const ImageF sigma_b = phase_sigma_cycles(frame.phase_b, frame.amplitude_b, noise.scale_b) *
                         static_cast<float>(limits.wavelength_b_m);
  half_inverse_variance_ = 0.5F / (sigma_a.square() + sigma_b.square());
}

float BeatCost::operator()(Eigen::Index row, Eigen::Index col, int n_a) const {
  const float a = frame_.phase_a(row, col);
  if (!count_within_limits(limits_, a, n_a)) return bound;
  const float residual_m = beat_residual_m(limits_, a, frame_.phase_b(row, col), n_a);
  return std::min(residual_m * residual_m * half_inverse_variance_(row, col), bound);
}

}  // namespace tofmap
