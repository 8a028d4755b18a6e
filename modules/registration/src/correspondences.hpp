// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A source point and the plane of the target point that it projects onto, along the world's axes
/// about the centre of the source's camera.
struct Correspondence {
  Eigen::Vector3d point_m;        ///< source point, relative to the centre of the source's camera
  Eigen::Vector3d normal;         ///< unit normal of the target's plane
  Eigen::Vector3d source_normal;  ///< unit normal of the source point
  double residual_m = 0;          ///< signed distance from the plane to the point
  double variance_m2 = 0;         ///< predicted variance of the residual
  double confidence = 1;          ///< probability that the wrap counts of both points are right
};

/// More correspondences than this are shared among threads. With fewer, synchronising threads costs
/// more than it saves.
inline constexpr std::size_t enough_for_threads = 4000;

/// The source points used for registration: every n-th pixel in both axes, where n is `stride_px`,
/// if it has a normal.
std::vector<const SurfacePoint*> select_points(const SurfaceCloud& source, int stride_px);

/// All correspondences at one pose.
struct Correspondences {
  std::vector<Correspondence> pairs;   ///< ordered by target, then by source point
  std::vector<std::size_t> of_target;  ///< number of pairs of each target
  double overlap = 0;                  ///< share of the source points in at least one pair
};

/// Projects source points into all targets. A point may have one correspondence per target. The
/// result is the same for any number of threads.
Correspondences find_correspondences(const std::vector<const SurfacePoint*>& points,
                                     const Pose& world_from_source,
                                     std::span<const RegistrationTarget> targets,
                                     const CameraModel& camera, const RegistrationOptions& options);

}  // namespace tofmap
