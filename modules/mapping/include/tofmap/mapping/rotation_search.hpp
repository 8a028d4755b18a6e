// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/keyframe.hpp>

namespace tofmap {

/// Initial poses for the registration of a frame whose camera may have turned far since the frame
/// before: rotations about the expected position for which the frame's ranges fit those that the
/// keyframes saw, best first.
///
/// All rotations of at most `reach_rad` from the expected one, about any axis, are tried in steps
/// of four degrees. The points of the keyframes are drawn as a panorama around the expected
/// position (SphericalView), and some 500 points of the cloud are compared with it by the
/// logarithms of their ranges, so that a translation by a tenth of the range does little harm. Of
/// rotations within eight degrees of each other the best one is returned, and at most `most` in
/// all. Empty if no rotation fits better than chance, or if the cloud or the keyframes have no
/// points with normals.
///
/// The result does not depend on the number of threads.
std::vector<Pose> search_rotations(const SurfaceCloud& cloud,
                                   std::span<const Keyframe* const> keyframes, const Pose& expected,
                                   double reach_rad, std::size_t most);

}  // namespace tofmap
