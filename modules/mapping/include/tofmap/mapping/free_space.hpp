// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>

namespace tofmap {

/// What keyframes, in the order of time, have seen at a point of a map.
struct Sightings {
  int violating = 0;        ///< number of keyframes that see through the point
  int agreeing = 0;         ///< number of keyframes that agree with it
  int violating_since = 0;  ///< number of those that see through it since the last one that agrees

  /// Whether the keyframes see through the point: more of them do so than agree with it, or at
  /// least three do so after the last one that agrees. One or two may be deceived.
  bool violates_free_space() const;
};

/// What keyframes, which are in the order of time, see at the points of a map. Keyframes of
/// recordings before the one in which a point was first seen do not count: it may not have been
/// there yet.
///
/// A keyframe sees through a point if the point lies in front of the keyframe's surfaces at the
/// pixel that it projects into and at the eight pixels around, each time by more than `margin_m`
/// plus three standard deviations of the surface along its normal. A keyframe's point without a
/// normal counts by its range alone, and only if its wrap count is nearly certain or if it is on
/// something that moves (moves()). Up to three of the nine pixels may have no range, but not the
/// one in the middle. The keyframe agrees with the point if the point lies within that distance of
/// the surface at its pixel. The result is the same for any number of threads.
std::vector<Sightings> sightings_of(const MapCloud& map, std::span<const Keyframe> keyframes,
                                    const CameraModel& camera, double margin_m);

/// Removes the points of a map that violate free space (sightings_of()): moving objects, flying
/// pixels, points with a wrong wrap count, and what has gone.
MapCloud without_free_space_violations(const MapCloud& map, std::span<const Keyframe> keyframes,
                                       const CameraModel& camera, double margin_m);

/// Share of free-space violations between two clouds: of those points of each that the other one
/// agrees with or sees through, as defined above, the share that it sees through. Every third point
/// is tested. 0 if neither sees anything of the other.
double free_space_violation_share(const RegistrationTarget& one, const RegistrationTarget& other,
                                  const CameraModel& camera, double margin_m);

/// Errors of poses that are tolerated where clouds are compared.
inline constexpr double tolerated_pose_error_m = 0.03;

/// Share of free-space violations from which on two clouds of one recording contradict each other.
inline constexpr double most_violations = 0.05;

/// The same for clouds of different recordings, between which furniture may have been moved.
inline constexpr double most_violations_since = 0.3;

/// Whether a cloud at the pose that registration has found contradicts the free space of a target:
/// of what both see of each other, they see through at least `most_share`
/// (free_space_violation_share()). Errors of the pose of `tolerated_pose_error_m` are tolerated.
bool contradicts_free_space(const RegistrationTarget& placed, const RegistrationTarget& target,
                            const CameraModel& camera, double most_share = most_violations);

}  // namespace tofmap
