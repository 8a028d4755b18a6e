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
/// plus three standard deviations of the surface along its normal. A keyframe's point without a
/// normal counts by its range alone, and only if its wrap count is nearly certain or if it is on
/// something that moves (moves()). Up to three of the nine pixels may have no range, but not the
/// one in the middle. The keyframe agrees with the point if the point lies within that distance of
/// the surface at its pixel. A point is removed if more keyframes see through it than agree with
/// it, or if at least three see through it after the last one that agrees: what it showed has gone.
/// `keyframes` are in the order of time. The result is the same for any number of threads.
MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m);

/// Share of free-space violations between two clouds: of those points of each that the other one
/// agrees with or sees through, as defined above, the share that it sees through. Every third point
/// is tested. 0 if neither sees anything of the other.
double free_space_violation_share(const RegistrationTarget& one, const RegistrationTarget& other,
                                  const CameraModel& camera, double margin_m);

/// Share of free-space violations from which on two clouds of one recording contradict each other.
inline constexpr double most_violations = 0.05;

/// The same for clouds of different recordings, between which furniture may have been moved.
inline constexpr double most_violations_since = 0.3;

/// Whether a cloud at the pose that registration has found contradicts the free space of a target:
/// of what both see of each other, they see through at least `most_share`
/// (free_space_violation_share()). Errors of the pose of 3 cm are tolerated.
bool contradicts_free_space(const RegistrationTarget& placed, const RegistrationTarget& target,
                            const CameraModel& camera, double most_share = most_violations);

}  // namespace tofmap
