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

/// Where a camera that was lost is found again.
struct Relocalisation {
  int keyframe = 0;  ///< id of the one it was recognised by
  RegistrationResult registration;
};

/// Finds the camera of a cloud without knowing where to look: the five keyframes that look most
/// like it are registered against, each with those before and after it, from where they stand. Of
/// registrations that a loop would be verified by the one that explains most of the cloud is it;
/// nothing if there is none, or if another place explains nearly as much.
std::optional<Relocalisation> relocalise(const SurfaceCloud& cloud,
                                         std::span<const Keyframe> keyframes,
                                         const CameraModel& camera, const LoopOptions& options,
                                         const RegistrationOptions& registration);

}  // namespace tofmap
