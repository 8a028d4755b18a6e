// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/odometry.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Chooses the keyframes that a frame is registered with, at most `odometry.targets`: those that
/// overlap it most at the pose of the prior, by at least `odometry.min_target_overlap`. The last of
/// `around` needs no overlap to fill a place that is left.
///
/// Keyframes that overlap a frame most need not constrain all directions: they may see its large
/// wall, but not the bit of ceiling beside it. So the last place goes to another keyframe if that
/// at least halves the standard deviation of the least certain translation, by the prior and the
/// surfaces together. The largest overlap comes first.
std::vector<const Keyframe*> choose_targets(const SurfaceCloud& cloud, const MotionPrior& prior,
                                            std::span<const Keyframe* const> around,
                                            const CameraModel& camera,
                                            const OdometryOptions& options,
                                            const RegistrationOptions& registration);

}  // namespace tofmap
