// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_pair.hpp"

#include <cstddef>
#include <vector>

namespace tofmap {

/// Pixels of A on smooth surfaces, bright enough that the residual tells their count: one number of
/// each kind for each. Where single pixels are too noisy, a sample is the mean of a window of up to
/// 7 x 7 pixels.
struct SurfaceSamples {
  std::vector<int> row;
  std::vector<int> col;
  std::vector<int> reach_px;  ///< of the window: 0 … 3
  std::vector<float> phase_a;
  std::vector<float> amplitude_a;  ///< empty if there is none
  std::vector<float> variance_a_m2;
  // Of the camera; empty if it is not known.
  std::vector<float> ray_x, ray_y, ray_z;
  std::vector<float> slope_x, slope_y;  ///< of the range along rows and columns, m/px
  std::vector<float> gradient_x, gradient_y, gradient_z;  ///< of the range on the sphere, m/rad

  std::size_t size() const { return phase_a.size(); }
};

/// Some 1500 samples, spread evenly. `residual_step_m` is the least change of the residual that a
/// count makes (tofmap/core/frequency_residual.hpp): the noise of a sample stays well below it.
SurfaceSamples gather_samples(const ExposurePair& pair, const PairGeometry& geometry,
                              double residual_step_m);

/// What B measured where it saw the samples.
struct SeenSamples {
  std::vector<Eigen::Index> place;     ///< of the pixel of B, row by row; −1: none
  std::vector<float> phase_b;          ///< NaN where B did not see the sample
  std::vector<float> variance_m2;      ///< of the residual: noise of both
  std::vector<float> shift_m;          ///< of the residual, by the motion that is assumed
  std::vector<float> amplitude_ratio;  ///< of B to A; empty without amplitudes
};

/// Looks samples up in B's image, where `motion` puts them at the ranges `range_m` (0: not known,
/// then as far as the phase alone says). `seen` is empty, or what an earlier motion showed: pixels
/// that stay are not averaged anew.
void look_up_samples(const SurfaceSamples& samples, const std::vector<float>& range_m,
                     const ExposurePair& pair, const PairGeometry& geometry,
                     const ExposureMotion& motion, SeenSamples& seen);

}  // namespace tofmap
