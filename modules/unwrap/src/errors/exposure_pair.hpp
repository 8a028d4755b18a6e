// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// If A and B see the same surface, their amplitudes differ by at most this factor, after
/// correction for the gain between them. Textures that are blurred differently cause such
/// differences.
inline constexpr float same_light_ratio = 1.42F;

/// References to the images of an exposure of A and of an exposure of B: phases and their standard
/// deviations in cycles, and amplitudes, which may be empty.
struct ExposurePair {
  const ImageF& phase_a;
  const ImageF& amplitude_a;
  const ImageF& sigma_a_cycles;
  const ImageF& phase_b;
  const ImageF& amplitude_b;
  const ImageF& sigma_b_cycles;

  bool has_amplitude() const { return amplitude_a.size() > 0 && amplitude_b.size() > 0; }
};

/// References to what is the same for all frames. `rays` is empty if the camera is unknown.
struct PairGeometry {
  const PairLimits& limits;
  const CameraModel& camera;
  const PixelRays& rays;

  bool knows_camera() const { return rays.x.size() > 0; }
};

/// The rotation matrix of a rotation vector: exp of SO(3).
Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& rotation_rad);

/// The map from a pixel of A with a range to its position in B's image, in single precision for
/// vectorised loops.
struct ExposureWarp {
  ExposureWarp(const CameraModel& camera, const ExposureMotion& motion);

  std::array<float, 9> b_from_a;       ///< rotation matrix, row by row
  std::array<float, 3> translation_m;  ///< position of B's camera in A's camera frame
  std::array<float, 4> pinhole;        ///< fx, fy, cx, cy
  std::array<float, 5> distortion;
};

/// Projects `count` points, given by their rays and ranges at A, into B's image. Writes their
/// positions to `col` and `row`, in pixels without rounding, and the range from A minus the range
/// from B to `shrinkage_m`. Positions of points behind the camera are NaN.
void warp(const ExposureWarp& warp, int count, const float* ray_x, const float* ray_y,
          const float* ray_z, const float* range_m, float* col, float* row, float* shrinkage_m);

/// Writes μ of CameraErrors for `count` pixels to `mean_m`, metres. `amplitude_a` may be null; then
/// the term with amplitude is left out. Where a phase is NaN, the result is an arbitrary finite
/// number.
void predict_camera_errors(const CameraErrors& errors, int count, const float* phase_a,
                           const float* phase_b, const float* amplitude_a, float* mean_m);

/// The two parts of predict_camera_errors(): predict_errors_of_a() writes all terms that do not
/// depend on B's phase, and add_errors_of_b() adds those that do.
void predict_errors_of_a(const CameraErrors& errors, int count, const float* phase_a,
                         const float* amplitude_a, float* mean_m);
void add_errors_of_b(const CameraErrors& errors, int count, const float* phase_b, float* mean_m);

/// Finds the wrap count whose residual is nearest to the predicted residual, for `count` pixels
/// (docs/unwrapping.md, equation 19). Writes the residual minus `predicted_m` to `error_m`, and the
/// range of A at that wrap count to `range_m`. Errors are NaN where a phase is NaN; ranges are NaN
/// where A's phase is NaN.
void find_nearest(const PairLimits& limits, int count, const float* phase_a, const float* phase_b,
                  const float* predicted_m, float* error_m, float* range_m);

}  // namespace tofmap
