// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// The rotation that shifts the image between two exposures as the camera's motion did. It includes
/// parallax: for surfaces at the range r, a translation t looks like the rotation
/// (−t_y / r, t_x / r, 0) (docs/unwrapping.md, equation 25).
struct ApparentRotation {
  Eigen::Vector3d rotation_rad;     ///< rotation vector in the frame of the first exposure
  Eigen::Matrix3d covariance_rad2;  ///< covariance of `rotation_rad`
};

/// Finds the apparent rotation for which the amplitudes of both exposures agree best. Needs no
/// ranges. Searches shifts of up to about a tenth of the image's width, coarse to fine, on averages
/// over blocks of pixels. Empty if the images are too small, or if amplitudes are missing or dark.
std::optional<ApparentRotation> align_exposures(const ImageF& amplitude_a,
                                                const ImageF& amplitude_b,
                                                const CameraModel& camera);

}  // namespace tofmap
