// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>

namespace tofmap {

/// Leaves out points that keyframes see through: what moved on, flying pixels, wrong wraps.
///
/// A keyframe sees through a point that lies in front of the surface it sees at the point's pixel
/// and at the eight around it, by more than `margin_m` and three standard deviations of the
/// surface. It agrees with one that lies within that of the surface at its pixel. A point goes if
/// at least two keyframes see through it and more than agree with it. Where a keyframe has no
/// surface it says nothing. The result is the same for any number of threads.
MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m);

}  // namespace tofmap
