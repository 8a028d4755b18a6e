// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Registers a cloud whose pose is known only roughly, in two stages: first with correspondence
/// distances up to twice the prior's standard deviation, at most 1 m, then from the resulting pose
/// with the given options.
RegistrationResult register_from_afar(const SurfaceCloud& cloud,
                                      std::span<const RegistrationTarget> targets,
                                      const CameraModel& camera, const MotionPrior& prior,
                                      const RegistrationOptions& registration);

/// Share of a cloud's points that fit the surfaces: the product of overlap and inlier ratio. 0 if
/// registration failed.
double support(const RegistrationResult& result);

/// Whether a registration that does not follow from the motion of the camera can be trusted: it
/// converged, reaches `min_overlap` and `min_inlier_ratio`, and has no degenerate direction.
bool is_verified(const RegistrationResult& result, const LoopOptions& options);

/// Whether a registration of a cloud near a keyframe is verified (is_verified()) and does not
/// contradict the free space of the keyframe (contradicts_free_space()). `is_of_one_recording`:
/// with the keyframe; if not, furniture may have been moved.
bool confirms_place(const Keyframe& keyframe, const SurfaceCloud& cloud,
                    const RegistrationResult& result, const CameraModel& camera,
                    const LoopOptions& options, bool is_of_one_recording = true);

}  // namespace tofmap
