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

/// Amplitudes of A and B that see the same surface differ by no larger factor, the gain between
/// them apart: textures may be blurred otherwise.
inline constexpr float same_light_ratio = 1.42F;

/// The images of A and those of one B; amplitudes may be empty.
struct ExposurePair {
  const ImageF& phase_a;
  const ImageF& amplitude_a;
  const ImageF& sigma_a_cycles;
  const ImageF& phase_b;
  const ImageF& amplitude_b;
  const ImageF& sigma_b_cycles;

  bool has_amplitude() const { return amplitude_a.size() > 0 && amplitude_b.size() > 0; }
};

/// What does not change from frame to frame. `rays` are empty if the camera is not known.
struct PairGeometry {
  const UnwrapLimits& limits;
  const CameraModel& camera;
  const PixelRays& rays;

  bool knows_camera() const { return rays.x.size() > 0; }
};

Eigen::Matrix3d rotation_matrix(const Eigen::Vector3d& rotation_rad);

/// Where points lie in B's image, given their rays and ranges at A, in plain floats.
struct ExposureWarp {
  ExposureWarp(const CameraModel& camera, const ExposureMotion& motion);

  std::array<float, 9> b_from_a;  ///< row by row
  std::array<float, 3> translation_m;
  std::array<float, 4> pinhole;  ///< fx, fy, cx, cy
  std::array<float, 5> distortion;
};

/// Pixels of B, not rounded, and by how much each range is less from B's place than from A's, for
/// `count` pixels. Behind the camera pixels are NaN.
void warp(const ExposureWarp& warp, int count, const float* ray_x, const float* ray_y,
          const float* ray_z, const float* range_m, float* col, float* row, float* shrinkage_m);

/// μ of `count` pixels; `amplitude` may be null. Phases that are NaN give any finite number.
void predict_camera_errors(const CameraErrors& errors, int count, const float* phase_a,
                           const float* phase_b, const float* amplitude_a, float* mean_m);

/// The two parts of it: without what depends on B's phase, and that, which is added.
void predict_errors_of_a(const CameraErrors& errors, int count, const float* phase_a,
                         const float* amplitude_a, float* mean_m);
void add_errors_of_b(const CameraErrors& errors, int count, const float* phase_b, float* mean_m);

/// The count whose residual is nearest to what is predicted of it, for `count` pixels: the residual
/// minus `predicted_m`, metres, and the range that the count gives to A. Phases that are NaN give a
/// residual of NaN.
void find_nearest(const UnwrapLimits& limits, int count, const float* phase_a, const float* phase_b,
                  const float* predicted_m, float* error_m, float* range_m);

}  // namespace tofmap
