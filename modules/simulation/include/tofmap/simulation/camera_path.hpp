// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// Where the camera should pass, and in which direction it should look there (any length).
struct Waypoint {
  Eigen::Vector3d position_m;
  Eigen::Vector3d direction;
};

/// Optical frame at `position`, looking along `direction`, with the image upright (world z up).
/// The direction must not be vertical.
Pose look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction);

Waypoint look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target);

/// How far the camera may move and turn from one frame to the next.
struct MotionLimits {
  double max_translation_m = 0.07;
  double max_rotation_rad = 0.0524;
};

/// A smooth camera path: uniform cubic B-splines through position and direction, which are
/// twice continuously differentiable and stay within the hull of the way points (they round off
/// corners, and never swing out). An open path starts and ends at its outer way points.
class CameraPath {
 public:
  CameraPath() = default;

  /// Throws UsageError with fewer than two way points (three for a closed path).
  CameraPath(std::vector<Waypoint> waypoints, bool closed);

  bool empty() const { return waypoints_.empty(); }
  bool closed() const { return closed_; }

  /// How far the spline parameter runs.
  double end() const;

  /// The pose at the spline parameter u, 0 … end(); clamped on an open path, periodic on a
  /// closed one.
  Pose pose_at(double u) const;

 private:
  const Waypoint& control(int index) const;

  std::vector<Waypoint> waypoints_;
  bool closed_ = false;
};

/// Where the camera is when it takes the images A and B of each frame; the timestamps are A's.
struct CameraMotion {
  Trajectory at_a;
  Trajectory at_b;
};

/// Runs along the path as fast as the limits allow, in steps of even effort: the root of the
/// squares of a step's translation and turn, each as a share of its limit. `frames` = 0: as
/// many as the whole path needs, but at least `min_frames`. More frames than the path needs
/// make the camera slower; with fewer it stops before the end. B follows A by `b_delay_share` of
/// a frame; the last B of an open path lies beyond its end by as much of the last step.
CameraMotion plan_motion(const CameraPath& path, const MotionLimits& limits, int frames,
                         int min_frames, double frame_rate_hz, double b_delay_share);

/// Follows recorded poses, a frame each (`frames` = 0: all); B's pose lies between A's and the
/// next, beyond the last one by the last step. Throws UsageError if there are no poses.
CameraMotion replay_motion(const Trajectory& poses, int frames, double b_delay_share);

}  // namespace tofmap
