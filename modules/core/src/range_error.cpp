// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/range_error.hpp"

#include <cmath>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Fills `sigma` for `count` pixels. `scale` is c of PhaseNoise, `ambient` is m, and
/// `rounding_variance` is q² / 12.
TOFMAP_VECTOR_CLONES void fill_sigma(int count, const float* phase, const float* amplitude,
                                     const float* ambient, float scale, float rounding_variance,
                                     float* sigma) {
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float light = amplitude[i] > 0 ? amplitude[i] : 0.0F;
    const float photons = scale * ambient[i] / light;
    const float total = std::sqrt(photons * photons + rounding_variance);
    sigma[i] = phase[i] == phase[i] && amplitude[i] > 0 ? total : nan;
  }
}

}  // namespace

ImageF phase_sigma_cycles(const ImageF& phase, const ImageF& amplitude, double scale,
                          double quantisation_cycles, const ImageF& ambient) {
  const Eigen::Index rows = phase.rows();
  const Eigen::Index cols = phase.cols();
  ImageF ones;
  if (amplitude.size() == 0 || ambient.size() == 0) ones.setOnes(rows, cols);
  ImageF sigma(rows, cols);
  fill_sigma(static_cast<int>(phase.size()), phase.data(),
             amplitude.size() > 0 ? amplitude.data() : ones.data(),
             ambient.size() > 0 ? ambient.data() : ones.data(), static_cast<float>(scale),
             static_cast<float>(quantisation_cycles * quantisation_cycles / 12), sigma.data());
  return sigma;
}

PhaseSigma::PhaseSigma(const Frame& frame, const std::vector<PhaseNoise>& noise,
                       const ImageF& ambient) {
  const ImageF none;
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    cycles.push_back(phase_sigma_cycles(frame.phases[f],
                                        frame.has_amplitude() ? frame.amplitudes[f] : none,
                                        noise[f].scale, noise[f].quantisation_cycles, ambient));
  }
}

}  // namespace tofmap
