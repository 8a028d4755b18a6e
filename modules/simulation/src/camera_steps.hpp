// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/ray_scene.hpp>

namespace tofmap {

/// The poses of the camera at evenly spaced times, at which the motion of people and doors is
/// planned. The first is a step before the first frame, and the last at least one after the last.
struct CameraSteps {
  Trajectory poses;
  double step_s = 0.1;

  double start_s() const { return poses.front().timestamp_s; }
  int count() const { return static_cast<int>(poses.size()); }
};

/// Steps of a tenth of a second, or longer if a recording would need more than 20 000 of them.
/// Beyond the first and the last pose, the camera moves on as it did. There must be at least one
/// pose, and timestamps must increase.
CameraSteps camera_steps(const Trajectory& poses);

/// The steps at which the camera sees a point: it is in the image, and no surface hides it.
std::vector<bool> steps_that_see(const CameraSteps& steps, const CameraModel& camera,
                                 const RayScene& still, const Eigen::Vector3d& point_m);

/// How large and how long something at `point_m` is in the picture: the sum over the steps that see
/// it of 1 / range², where ranges below 1.5 m count as 1.5 m.
double visibility(const CameraSteps& steps, const CameraModel& camera, const RayScene& still,
                  const Eigen::Vector3d& point_m);

}  // namespace tofmap
