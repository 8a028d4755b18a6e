// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A place that the camera path leads past, and the viewing direction there. World frame, z up.
struct Waypoint {
  Eigen::Vector3d position_m;
  Eigen::Vector3d direction;  ///< of any length, not vertical
};

/// The pose of a camera at `position`, metres, whose optical axis points along `direction` and
/// whose image is upright (world z is up). The direction must not be vertical.
Pose look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction);

/// A waypoint at `position` that looks at `target`, metres.
Waypoint look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target);

/// The largest motion of the camera from one frame to the next.
struct MotionLimits {
  double max_translation_m = 0.07;
  double max_rotation_rad = 0.0524;
};

/// A smooth camera path: uniform cubic B-splines of position and direction, with the waypoints as
/// control points. They are twice continuously differentiable and stay within the convex hull of
/// the waypoints: the path cuts corners, but never overshoots. An open path starts and ends at its
/// outer waypoints.
class CameraPath {
 public:
  /// An empty path. It has no poses.
  CameraPath() = default;

  /// Throws UsageError if there are fewer than two waypoints, or fewer than three for a closed
  /// path.
  CameraPath(std::vector<Waypoint> waypoints, bool closed);

  bool empty() const { return waypoints_.empty(); }
  bool closed() const { return closed_; }
  const std::vector<Waypoint>& waypoints() const { return waypoints_; }

  /// The largest value of the spline parameter.
  double end() const;

  /// The pose at the spline parameter u, 0 … end(). Other values are clamped on an open path and
  /// wrapped around on a closed path.
  Pose pose_at(double u) const;

 private:
  const Waypoint& control(int index) const;

  std::vector<Waypoint> waypoints_;
  bool closed_ = false;
};

/// The poses of the camera when it takes the images of each frame.
struct CameraMotion {
  /// A trajectory for each image of a frame, all with the timestamps of the frames.
  std::vector<Trajectory> at;
};

/// Moves a camera along a path. All steps between frames have the same size, which is the root of
/// the sum of (translation / max_translation_m)² and (rotation / max_rotation_rad)², at most 0.95.
///
/// If `frames` is 0, there are as many frames as the whole path needs, but at least `min_frames`.
/// With more frames than the path needs the camera moves more slowly; with fewer frames it stops
/// before the end of the path. Each image is taken `delay_shares` of a frame period after the
/// timestamp of its frame, 0 … 1. The late images of the last frame of an open path lie beyond the
/// end of the path, by the same fraction of the last step.
CameraMotion plan_motion(const CameraPath& path, const MotionLimits& limits, int frames,
                         int min_frames, double frame_rate_hz,
                         const std::vector<double>& delay_shares);

/// Replays recorded poses, one per frame: the first `frames` of them, or all if `frames` is 0. The
/// pose at an image is interpolated between the pose of its frame and the next pose, at the
/// fraction `delay_shares` of the image; after the last pose, the last step is extrapolated. Throws
/// UsageError if `poses` is empty.
CameraMotion replay_motion(const Trajectory& poses, int frames,
                           const std::vector<double>& delay_shares);

}  // namespace tofmap
