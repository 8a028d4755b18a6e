// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "camera_steps.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

using Eigen::Vector3d;

/// Whether the camera sees a point, and from what range.
std::optional<double> range_seen_m(const Pose& world_from_camera, const CameraModel& camera,
                                   const RayScene& still, const Vector3d& point_m) {
  constexpr double before_surface_m = 0.01;
  const auto pixel = project(camera, world_from_camera.inverse() * point_m);
  const bool is_in_image = pixel && pixel->x() > -0.5 && pixel->x() < camera.width_px - 0.5 &&
                           pixel->y() > -0.5 && pixel->y() < camera.height_px - 0.5;
  if (!is_in_image) return std::nullopt;
  const Vector3d sight = point_m - world_from_camera.translation();
  const double range_m = sight.norm();
  if (still.cast(world_from_camera.translation(), sight / range_m, range_m - before_surface_m)) {
    return std::nullopt;
  }
  return range_m;
}

}  // namespace

CameraSteps camera_steps(const Trajectory& poses) {
  constexpr double usual_step_s = 0.1;
  constexpr double max_steps = 20000;
  CameraSteps steps;
  const double span_s = std::max(0.0, poses.back().timestamp_s - poses.front().timestamp_s);
  steps.step_s = std::max(usual_step_s, span_s / max_steps);
  const double start_s = poses.front().timestamp_s - steps.step_s;
  const int count = static_cast<int>(std::ceil(span_s / steps.step_s)) + 3;
  std::size_t next = 1;
  for (int i = 0; i < count; ++i) {
    const double time_s = start_s + i * steps.step_s;
    if (poses.size() == 1) {
      steps.poses.push_back({time_s, poses[0].world_from_camera});
      continue;
    }
    while (next + 1 < poses.size() && poses[next].timestamp_s < time_s) ++next;
    const StampedPose& a = poses[next - 1];
    const StampedPose& b = poses[next];
    const double between_s = b.timestamp_s - a.timestamp_s;
    const double share = between_s > 0 ? (time_s - a.timestamp_s) / between_s : 0;
    constexpr double most_beyond = 1;  // of the motion between two frames
    steps.poses.push_back({time_s, interpolate(a.world_from_camera, b.world_from_camera,
                                               std::clamp(share, -most_beyond, 1 + most_beyond))});
  }
  return steps;
}

std::vector<bool> steps_that_see(const CameraSteps& steps, const CameraModel& camera,
                                 const RayScene& still, const Vector3d& point_m) {
  std::vector<bool> seen;
  for (const StampedPose& pose : steps.poses) {
    seen.push_back(range_seen_m(pose.world_from_camera, camera, still, point_m).has_value());
  }
  return seen;
}

double visibility(const CameraSteps& steps, const CameraModel& camera, const RayScene& still,
                  const Vector3d& point_m) {
  constexpr double near_m = 1.5;
  constexpr std::size_t samples = 200;  // a long recording is judged by some of its steps
  const std::size_t stride = std::max<std::size_t>(1, steps.poses.size() / samples);
  double sum = 0;
  for (std::size_t i = 0; i < steps.poses.size(); i += stride) {
    const auto range_m = range_seen_m(steps.poses[i].world_from_camera, camera, still, point_m);
    if (range_m) sum += 1 / std::pow(std::max(*range_m, near_m), 2);
  }
  return sum;
}

}  // namespace tofmap
