// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <cstddef>
#include <vector>

namespace tofmap {

/// Samples of A on smooth surfaces whose noise is small enough for the residual to determine the
/// wrap count. Where single pixels are too noisy, a sample is the mean over a window of up to 7 x 7
/// pixels. All vectors have one element per sample, except for those that are empty.
struct SurfaceSamples {
  std::vector<int> row;              ///< of the window's middle pixel
  std::vector<int> col;              ///< of the window's middle pixel
  std::vector<int> reach_px;         ///< the window has 2 reach_px + 1 pixels a side; 0 … 3
  std::vector<float> phase_a;        ///< mean over the window, 0 … 1 cycles
  std::vector<float> amplitude_a;    ///< of the middle pixel; empty without amplitudes
  std::vector<float> variance_a_m2;  ///< variance of the noise of A's range
  // The following are empty if the camera is unknown.
  std::vector<float> ray_x, ray_y, ray_z;
  std::vector<float> slope_x, slope_y;  ///< slope of the range per column and per row, m/px
  /// Gradient of the range over ray directions, m/rad.
  std::vector<float> gradient_x, gradient_y, gradient_z;

  std::size_t size() const { return phase_a.size(); }
};

/// Gathers about 1500 samples, spread evenly over the image; fewer where the image is noisy or not
/// smooth. `residual_step_m` is the smallest change of the residual that another wrap count makes
/// (tofmap/core/frequency_residual.hpp). The noise of a sample stays well below it.
SurfaceSamples gather_samples(const ExposurePair& pair, const PairGeometry& geometry,
                              double residual_step_m);

/// What B measured of SurfaceSamples, for an assumed motion. All vectors have one element per
/// sample, except for those that are empty.
struct SeenSamples {
  std::vector<Eigen::Index> place;     ///< index of B's pixel, row by row; −1 outside the image
  std::vector<float> phase_b;          ///< NaN where B did not see the sample
  std::vector<float> variance_m2;      ///< variance of the residual by the noise of A and B
  std::vector<float> shift_m;          ///< change of the residual by the motion
  std::vector<float> amplitude_ratio;  ///< B's amplitude over A's; empty without amplitudes
};

/// Looks samples up in B's image, at the positions to which `motion` moves them if their ranges are
/// `range_m`. `seen` is either empty or the result for an earlier motion: samples that stay in
/// their pixel of B are not averaged again.
void look_up_samples(const SurfaceSamples& samples, const std::vector<float>& range_m,
                     const ExposurePair& pair, const PairGeometry& geometry,
                     const ExposureMotion& motion, SeenSamples& seen);

}  // namespace tofmap
