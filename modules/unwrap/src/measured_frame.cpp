// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "measured_frame.hpp"

#include "median.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <tofmap/core/error.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

void check(const DualFrequencyFrame& frame) {
  const bool agree = same_size(frame.phase_a, frame.phase_b) &&
                     (!frame.has_amplitude() || (same_size(frame.phase_a, frame.amplitude_a) &&
                                                 same_size(frame.phase_a, frame.amplitude_b)));
  if (!agree) {
    throw UsageError("unwrap: frame " + std::to_string(frame.index) +
                     ": images differ in size; phases and amplitudes must have one size, or "
                     "amplitudes be empty");
  }
}

/// Pixels with amplitudes: those with a finite phase and some light at both frequencies are valid,
/// unless one of them is saturated.
TOFMAP_VECTOR_CLONES void keep_lit(int pixels, const float* amplitude_a, const float* amplitude_b,
                                   float saturation, float* phase_a, float* phase_b,
                                   std::uint8_t* valid, std::uint8_t* saturated) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float a = amplitude_a[i];
    const float b = amplitude_b[i];
    // No number is left of an infinite phase, nor of a missing one.
    const float present = 0 * phase_a[i] + 0 * phase_b[i];
    const bool is_lit = present == 0 && a > 0 && b > 0;
    const bool is_saturated = is_lit && (a >= saturation || b >= saturation);
    const bool is_valid = is_lit && !is_saturated;
    valid[i] = is_valid ? 1 : 0;
    saturated[i] = is_saturated ? 1 : 0;
    phase_a[i] = is_valid ? phase_a[i] : nan;
    phase_b[i] = is_valid ? phase_b[i] : nan;
  }
}

}  // namespace

MeasuredFrame::MeasuredFrame(const DualFrequencyFrame& frame, double saturation_amplitude)
    : returns(frame) {
  check(frame);
  const Eigen::Index rows = frame.phase_a.rows();
  const Eigen::Index cols = frame.phase_a.cols();
  valid.resize(rows, cols);
  saturated.resize(rows, cols);
  const ImageF lit = frame.has_amplitude() ? ImageF() : ImageF::Ones(rows, cols);
  const bool can_saturate = frame.has_amplitude() && saturation_amplitude > 0;
  keep_lit(static_cast<int>(valid.size()),
           frame.has_amplitude() ? frame.amplitude_a.data() : lit.data(),
           frame.has_amplitude() ? frame.amplitude_b.data() : lit.data(),
           can_saturate ? static_cast<float>(saturation_amplitude)
                        : std::numeric_limits<float>::infinity(),
           returns.phase_a.data(), returns.phase_b.data(), valid.data(), saturated.data());
  noise = estimate_phase_noise(returns);
  sigma = PhaseSigma(returns, noise);
}

double median_phase_noise_cycles(const MeasuredFrame& frame) {
  const ImageF& sigma = frame.sigma.a_cycles;
  std::vector<float> sigmas;
  sigmas.reserve(static_cast<std::size_t>(sigma.size()));
  std::copy_if(sigma.data(), sigma.data() + sigma.size(), std::back_inserter(sigmas),
               [](float s) { return std::isfinite(s); });
  return sigmas.empty() ? 0 : median_of_positive(sigmas);
}

}  // namespace tofmap
