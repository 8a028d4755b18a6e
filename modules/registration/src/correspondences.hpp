// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A source point and the plane of a target it fell on, in world axes about a local origin.
struct Correspondence {
  Eigen::Vector3d point_m;      ///< source point, relative to the origin
  Eigen::Vector3d normal;       ///< of the target's plane
  double residual_m = 0;        ///< signed, from plane to point
  double variance_m2 = 0;       ///< predicted, of the residual
  double confidence = 1;        ///< probability that both points are where they are measured
  double normal_sigma_rad = 0;  ///< of the plane's tilt
};

/// The source points that take part: every stride-th pixel in both axes that has a normal.
std::vector<const SurfacePoint*> select_points(const SurfaceCloud& source, int stride_px);

/// All pairs at one pose.
struct Correspondences {
  std::vector<Correspondence> pairs;  ///< ordered by target, then source point
  double overlap = 0;                 ///< share of the source points that have any
};

Correspondences find_correspondences(const std::vector<const SurfacePoint*>& points,
                                     const Pose& world_from_source,
                                     std::span<const RegistrationTarget> targets,
                                     const CameraModel& camera, const RegistrationOptions& options);

}  // namespace tofmap
