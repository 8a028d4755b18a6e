// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {

/// The properties of the sensor and scene that stay the same over a recording.
struct SensorModel {
  CameraModel camera;
  Modulation modulation;
  /// Largest range in the scene. 0: unknown; the combined range of the two frequencies then limits
  /// the wrap counts.
  double max_range_m = 0;
  /// A pixel with this amplitude or a larger one is saturated, and its phase is not used. 0: no
  /// pixel is saturated.
  double saturation_amplitude = 0;
};

/// One measurement of a dual-frequency time-of-flight camera.
///
/// All images that are present have the camera's size. A pixel without a return at one frequency
/// may have one at the other.
struct DualFrequencyFrame {
  int index = 0;           ///< position in the recording, from 0
  double timestamp_s = 0;  ///< of image A; B may have been taken up to one frame period later
  /// Phase in cycles, [0, 1): `phase = (range / λ) mod 1`. NaN where there is no return.
  ImageF phase_a;
  ImageF phase_b;  ///< like phase_a, at frequency B
  /// Amplitude, linear in the signal, in an arbitrary scale. Both amplitude images are empty
  /// (0 x 0) if the camera delivers no amplitudes.
  ImageF amplitude_a;
  ImageF amplitude_b;  ///< like amplitude_a, at frequency B

  bool has_amplitude() const { return amplitude_a.size() > 0; }
};

/// Whether no pixel has a return at both frequencies.
inline bool is_without_return(const DualFrequencyFrame& frame) {
  return (frame.phase_a.isNaN() || frame.phase_b.isNaN()).all();
}

/// Whether a frame has the same phases as the frame `last` before it, at both frequencies. Frames
/// without any return do not repeat each other: the camera may be covered.
inline bool repeats(const DualFrequencyFrame& frame, const DualFrequencyFrame& last) {
  return same_values(frame.phase_a, last.phase_a) && same_values(frame.phase_b, last.phase_b) &&
         !is_without_return(frame);
}

}  // namespace tofmap
