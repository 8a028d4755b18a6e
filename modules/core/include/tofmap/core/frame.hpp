// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {

/// The properties of the sensor and scene that stay the same over a recording.
struct SensorModel {
  CameraModel camera;
  Modulation modulation;
  /// Largest range in the scene. 0: unknown; the combined range of the frequencies then limits
  /// the wrap counts.
  double max_range_m = 0;
  /// A pixel with this amplitude or a larger one is saturated, and its phase is not used. 0: no
  /// pixel is saturated.
  double saturation_amplitude = 0;
};

/// One measurement of a time-of-flight camera, at one to eight modulation frequencies.
///
/// All images that are present have the camera's size. A pixel without a return at one frequency
/// may have one at another.
struct Frame {
  int index = 0;           ///< position in the recording, from 0
  double timestamp_s = 0;  ///< of the first frequency; the others may have been taken up to one
                           ///< frame period later (Modulation::exposure_offsets_s)
  /// Phase at each frequency in cycles, [0, 1): `phase = (range / λ) mod 1`. NaN where there is no
  /// return.
  std::vector<ImageF> phases;
  /// Amplitude at each frequency, linear in the signal, in an arbitrary scale. No images, or empty
  /// ones (0 x 0), if the camera delivers no amplitudes.
  std::vector<ImageF> amplitudes;

  /// The number of frequencies.
  std::size_t frequencies() const { return phases.size(); }
  bool has_amplitude() const { return !amplitudes.empty() && amplitudes.front().size() > 0; }
  Eigen::Index rows() const { return phases.empty() ? 0 : phases.front().rows(); }
  Eigen::Index cols() const { return phases.empty() ? 0 : phases.front().cols(); }
};

/// A frame of empty images (0 x 0) at this number of frequencies.
Frame blank_frame(std::size_t frequencies);

/// The images of these frequencies alone, which are counted from 0, in this order.
Frame with_frequencies(const Frame& frame, const std::vector<std::size_t>& frequencies);

/// The sensor as if it had these frequencies alone, in this order.
SensorModel with_frequencies(const SensorModel& sensor,
                             const std::vector<std::size_t>& frequencies);

/// Whether no pixel has a return at all frequencies.
bool is_without_return(const Frame& frame);

/// Whether a frame has the same phases as the frame `last` before it, at all frequencies. Frames
/// without any return do not repeat each other: the camera may be covered.
bool repeats(const Frame& frame, const Frame& last);

}  // namespace tofmap
