// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <numbers>

#include <Eigen/Core>

namespace tofmap {

class ByteReader;
class ByteWriter;

/// The systematic errors of a camera as far as they differ between two of its frequencies, A and B.
/// The model is
///
///   μ = o + Σ_k (a_k cos 2πkφ_A + b_k sin 2πkφ_A + c_k cos 2πkφ_B + d_k sin 2πkφ_B)
///       + e log10(amplitude_A / reference_amplitude),                         k = 1 … harmonics
///
/// where μ is the difference, in metres, between A's range and B's at the right wrap counts if the
/// camera does not move (docs/unwrapping.md, equation 18). All members are zero or neutral for
/// methods that do not estimate these errors.
struct CameraErrors {
  static constexpr int harmonics = 4;
  static constexpr int coefficients = 2 + 4 * harmonics;

  /// The coefficients of μ in the order o, a_1, b_1, c_1, d_1, a_2 … d_4, e; metres.
  std::array<double, coefficients> coefficient_m{};
  /// Median amplitude at A in the first frame; 1 without amplitudes.
  double reference_amplitude = 1;
  /// Median ratio of B's amplitude to A's.
  double amplitude_gain = 1;
  /// Standard deviation of the periodic part of μ over the phases of the frames so far.
  double periodic_rms_m = 0;
  /// Standard deviation of the difference between the frequencies that neither μ nor noise
  /// explains. Averaging over pixels does not reduce it.
  double systematic_m = 0;
  /// The number of frames that the model was learned from; 0: nothing is known.
  int frames = 0;
  /// Number of consecutive frames up to the latest one whose B was exposed late: up to one frame
  /// period after A, not directly after it.
  int late_frames = 0;

  /// o: the constant part of the difference.
  double offset_m() const { return coefficient_m.front(); }
  /// e: the change of the difference per decade of amplitude.
  double per_decade_m() const { return coefficient_m.back(); }
};

/// Writes the errors of a camera, exact to the bit.
void save(const CameraErrors& camera, ByteWriter& out);

/// Reads what save() wrote. Throws InputError if the bytes are damaged.
CameraErrors camera_errors_in(ByteReader& in);

/// Standard deviation of the systematic error of one range, metres. It follows from systematic_m,
/// that of the difference between two ranges, on the assumption that the errors at A and B are
/// independent and equally large. The fused range of both frequencies gets the same value.
inline double range_systematic_m(const CameraErrors& camera) {
  return camera.systematic_m / std::numbers::sqrt2;
}

/// The camera's motion between the exposures of A and B: the position `translation_m` of the camera
/// at B's exposure and its rotation as a rotation vector, both in the camera frame of A.
struct ExposureMotion {
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rotation_rad = Eigen::Vector3d::Zero();
};

/// The errors of one frame besides its noise.
struct FrameErrors {
  CameraErrors camera;       ///< estimated from this frame and all frames before
  ExposureMotion motion;     ///< zero if it could not be estimated
  double flow_px = 0;        ///< shift of the image from A to B by the motion: 90th percentile
  bool used_last_b = false;  ///< whether the B of the frame before was used as well
  double support = 0;        ///< share of the samples whose residual and amplitude are as predicted
  int pixels = 0;            ///< samples that the estimate is based on; 0: too few for an estimate,
                             ///< then only `camera` is known, from the frames before
};

}  // namespace tofmap
