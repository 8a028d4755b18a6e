// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap {

/// The rotation of the camera between two exposures, a rotation vector in the frame of A, at which
/// their amplitudes agree best. Needs no range: translation is neglected. Searches up to a tenth of
/// the image's width, by blocks of pixels, coarse to fine. Zero where amplitudes are missing or
/// dark.
Eigen::Vector3d align_exposures(const ImageF& amplitude_a, const ImageF& amplitude_b,
                                const CameraModel& camera);

}  // namespace tofmap
