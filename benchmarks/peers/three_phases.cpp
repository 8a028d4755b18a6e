// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/three_phases.hpp"

#include <cmath>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap::peers {
namespace {

void check(const ThreePhases& measured) {
  const ImageF& first = measured.phase_cycles[0];
  if (first.size() == 0) throw UsageError("three phases: the images are empty");
  for (std::size_t m = 0; m < 3; ++m) {
    if (!same_size(measured.phase_cycles[m], first) || !same_size(measured.amplitude[m], first))
      throw UsageError(
          fmt::format("three phases: the images of frequency {} have another size", m));
    if (!(measured.frequencies_hz[m] > 0))
      throw UsageError(fmt::format("three phases: frequency {} is {} Hz, but must be positive", m,
                                   measured.frequencies_hz[m]));
  }
}

/// Adds `shift` (0 ≤ shift < 1) to phases. Keeps NaN.
TOFMAP_VECTOR_CLONES void shift_phases(Eigen::Index count, float shift, float* phase) {
  for (Eigen::Index i = 0; i < count; ++i) {
    const float sum = phase[i] + shift;
    phase[i] = sum >= 1 ? sum - 1 : sum;
  }
}

TOFMAP_VECTOR_CLONES void scale_amplitudes(Eigen::Index count, float factor, float* amplitude) {
  for (Eigen::Index i = 0; i < count; ++i) amplitude[i] *= factor;
}

/// Makes `image` NaN wherever `mask` is NaN, and keeps it elsewhere.
TOFMAP_VECTOR_CLONES void copy_nan(Eigen::Index count, const float* mask, float* image) {
  for (Eigen::Index i = 0; i < count; ++i) image[i] = mask[i] == mask[i] ? image[i] : mask[i];
}

}  // namespace

ThreePhases calibrated(const ThreePhases& measured, const CameraFacts& facts) {
  check(measured);
  ThreePhases out = measured;
  const Eigen::Index count = out.phase_cycles[0].size();
  const ImageF any = out.phase_cycles[0] + out.phase_cycles[1] + out.phase_cycles[2] +
                     out.amplitude[0] + out.amplitude[1] + out.amplitude[2];
  for (std::size_t m = 0; m < 3; ++m) {
    const double bias = facts.phase_bias_cycles[m];
    const double shift = -bias - std::floor(-bias);
    if (shift != 0) shift_phases(count, static_cast<float>(shift), out.phase_cycles[m].data());
    if (facts.amplitude_scale != 1)
      scale_amplitudes(count, static_cast<float>(facts.amplitude_scale), out.amplitude[m].data());
    copy_nan(count, any.data(), out.phase_cycles[m].data());
    copy_nan(count, any.data(), out.amplitude[m].data());
  }
  return out;
}

}  // namespace tofmap::peers
