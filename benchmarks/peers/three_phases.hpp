// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/core/image.hpp>

namespace tofmap::peers {

/// What a camera of three modulation frequencies measures. All images have the same size. A pixel
/// with NaN in any image has no return.
struct ThreePhases {
  std::array<ImageF, 3> phase_cycles;  ///< [0, 1)
  std::array<ImageF, 3> amplitude;     ///< in the unit of the camera
  /// In the order of the images; the default is that of the Kinect v2.
  std::array<double, 3> frequencies_hz{80e6, 16e6, 120e6};

  [[nodiscard]] Eigen::Index rows() const { return phase_cycles[0].rows(); }
  [[nodiscard]] Eigen::Index cols() const { return phase_cycles[0].cols(); }
};

/// Facts about the camera that both peers need. The defaults leave the measurements as they are.
struct CameraFacts {
  /// Subtracted from the phases of each frequency before they are unwrapped.
  std::array<double, 3> phase_bias_cycles{0, 0, 0};
  /// Factor from the caller's amplitudes to those of libfreenect2, which the amplitude limits and
  /// noise models of both peers refer to.
  double amplitude_scale = 1;
  /// libfreenect2 takes 3e8 m/s, which makes its ranges longer by 0.07 %.
  double speed_of_light_m_s = 299792458;
};

/// The phases and amplitudes of `measured`, with the bias subtracted and in libfreenect2's unit. A
/// pixel without a return is NaN in all images. Throws UsageError if the images differ in size or
/// are empty, or a frequency is not positive.
ThreePhases calibrated(const ThreePhases& measured, const CameraFacts& facts);

}  // namespace tofmap::peers
