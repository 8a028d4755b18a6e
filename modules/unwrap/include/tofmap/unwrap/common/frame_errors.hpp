// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <numbers>

#include <Eigen/Core>

namespace tofmap {

/// What is known of the systematic errors in which the two frequencies of a camera differ:
///
///   μ = o + Σ_k (a_k cos 2πkφ_A + b_k sin 2πkφ_A + c_k cos 2πkφ_B + d_k sin 2πkφ_B)
///       + e log10(amplitude_A / reference_amplitude),                         k = 1 … harmonics
///
/// is what A's range exceeds B's by, metres, at the right wrap count and without motion
/// (docs/unwrapping.md, equation 18).
struct CameraErrors {
  static constexpr int harmonics = 4;
  static constexpr int coefficients = 2 + 4 * harmonics;

  /// o, a_1, b_1, c_1, d_1, a_2 …, e; metres.
  std::array<double, coefficients> coefficient_m{};
  double reference_amplitude = 1;
  double amplitude_gain = 1;  ///< of B against A
  double periodic_rms_m = 0;  ///< of the periodic part, at the phases that were seen
  double systematic_m = 0;    ///< standard deviation of what μ leaves; averaging does not lower it
  int frames = 0;             ///< that took part; 0: nothing is known
  int late_frames = 0;        ///< in a row up to the last: B came later than right after A

  double offset_m() const { return coefficient_m.front(); }
  double per_decade_m() const { return coefficient_m.back(); }
};

/// Standard deviation of a range's systematic error, as far as the other frequency tells: both err
/// alike much and independently, and the mean of both errs no more.
inline double range_systematic_m(const CameraErrors& camera) {
  return camera.systematic_m / std::numbers::sqrt2;
}

/// How the camera moved between the exposures of A and B: to `translation_m`, and by the rotation
/// vector `rotation_rad`, in the camera frame of A.
struct ExposureMotion {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
};

/// What is known of the errors of one frame beyond its noise.
struct FrameErrors {
  CameraErrors camera;  ///< as this frame shows it, on top of the frames before
  ExposureMotion motion;
  double flow_px = 0;  ///< by how far the motion shifts the image from A to B: most of it by less
  bool used_last_b = false;  ///< the B of the frame before was nearer in time, and took part
  double support =
      0;  ///< share of the pixels that took part whose residual and amplitude are as predicted
  int pixels = 0;  ///< that took part in the estimate; 0: too few, and only `camera` is known
};

}  // namespace tofmap
