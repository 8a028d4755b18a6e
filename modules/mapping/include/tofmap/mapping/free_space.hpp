// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>

namespace tofmap {

/// Removes the points of a map that violate free space, that is, points at places that keyframes
/// see through: moving objects, flying pixels and points with a wrong wrap count.
///
/// A keyframe sees through a point if the point lies in front of the keyframe's surfaces at the
/// pixel that it projects into and at the eight pixels around, each time by more than `margin_m`
/// plus three standard deviations of the surface along its normal. The keyframe agrees with the
/// point if the point lies within that distance of the surface at its pixel. A keyframe that has no
/// surface at one of the nine pixels does not see through the point. A point is removed if at least
/// two keyframes see through it, and more than agree with it. The result is the same for any number
/// of threads.
MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m);

}  // namespace tofmap
