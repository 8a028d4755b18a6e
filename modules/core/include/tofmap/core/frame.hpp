// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {

/// What is fixed over a recording: the camera, its two frequencies, how far the scene can reach
/// (0: not known; then the pair's combined range limits the wraps), and the amplitude from which on
/// a pixel counts as saturated, its phase as spoiled (0: none does).
struct SensorModel {
  CameraModel camera;
  Modulation modulation;
  double max_range_m = 0;
  double saturation_amplitude = 0;
};

/// What a dual-frequency time-of-flight camera measures at one instant.
///
/// Phases are in cycles, [0, 1): `phase = (range / λ) mod 1`; NaN where there is no return.
/// A pixel without a return at one frequency may have one at the other.
/// Amplitudes are linear in the signal, in any one scale; both images are empty (0 x 0) if
/// the camera gives none. All images that are present have the camera's size.
/// The timestamp is A's; B may have been taken up to one frame period later.
struct DualFrequencyFrame {
  int index = 0;
  double timestamp_s = 0;
  ImageF phase_a;
  ImageF phase_b;
  ImageF amplitude_a;
  ImageF amplitude_b;

  bool has_amplitude() const { return amplitude_a.size() > 0; }
};

}  // namespace tofmap
