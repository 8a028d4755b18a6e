// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_closure.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// The pose of a camera that was found without knowledge of its motion.
struct Relocalisation {
  int keyframe = 0;                 ///< id of the keyframe that the camera was recognised by
  RegistrationResult registration;  ///< with that keyframe and its neighbours
};

/// Finds the pose of a cloud among keyframes without an initial pose.
///
/// The cloud is registered with each of the five keyframes that look most similar, from the pose of
/// that keyframe (register_near()). Of the results that are verified as for a loop (is_verified()),
/// the one with the largest product of overlap and inlier ratio is returned. Empty if none is
/// verified, or if another place reaches more than 90 % of that product. `keyframes` are in the
/// order of their ids, from 0.
std::optional<Relocalisation> relocalise(const SurfaceCloud& cloud,
                                         std::span<const Keyframe> keyframes,
                                         const CameraModel& camera, const LoopOptions& options,
                                         const RegistrationOptions& registration);

}  // namespace tofmap
