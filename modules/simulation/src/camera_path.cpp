// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/camera_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Weights of the four control points of a segment of a uniform cubic B-spline, 0 ≤ t < 1.
std::array<double, 4> spline_weights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
          t * t * t / 6};
}

/// Largest step as a fraction of the allowed one. It leaves room for rounding.
constexpr double limit_share = 0.95;

/// The effort of motion from the start of the path to evenly spaced values of u. The effort of a
/// step is the root of the squares of its translation and rotation, each divided by its limit.
struct EffortTable {
  std::vector<double> u;
  std::vector<double> effort;

  EffortTable(const CameraPath& path, const MotionLimits& limits) {
    constexpr int samples_per_segment = 100;
    const int samples = static_cast<int>(path.end()) * samples_per_segment;
    Pose last = path.pose_at(0);
    double sum = 0;
    for (int i = 0; i <= samples; ++i) {
      u.push_back(path.end() * i / samples);
      const Pose pose = path.pose_at(u.back());
      const double step =
          (pose.translation() - last.translation()).norm() / limits.max_translation_m;
      sum += std::hypot(step, rotation_angle_rad(last, pose) / limits.max_rotation_rad);
      effort.push_back(sum);
      last = pose;
    }
  }

  double total() const { return effort.back(); }

  /// The spline parameter that is reached with this effort. Beyond the end of the path it continues
  /// into the next period.
  double place(double spent) const {
    if (spent > total()) return u.back() + (total() > 0 ? place(spent - total()) : 0);
    const auto above = std::ranges::lower_bound(effort, spent);
    const auto i = static_cast<std::size_t>(above - effort.begin());
    if (i == 0) return u.front();
    const double share = (spent - effort[i - 1]) / (effort[i] - effort[i - 1]);
    return u[i - 1] + share * (u[i] - u[i - 1]);
  }
};

}  // namespace

Pose look_along(const Eigen::Vector3d& position, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d z = direction.normalized();
  const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
  Pose pose = Pose::Identity();
  pose.linear() << x, z.cross(x), z;
  pose.translation() = position;
  return pose;
}

Waypoint look_at(const Eigen::Vector3d& position, const Eigen::Vector3d& target) {
  return {position, (target - position).normalized()};
}

CameraPath::CameraPath(std::vector<Waypoint> waypoints, bool closed)
    : waypoints_(std::move(waypoints)), closed_(closed) {
  if (waypoints_.size() < (closed ? 3U : 2U)) {
    throw UsageError("a camera path needs at least two waypoints, or three if it is closed");
  }
}

double CameraPath::end() const {
  // The first and the last waypoint of an open path count three times, which adds two segments to
  // the n − 1 between them.
  return static_cast<double>(waypoints_.size()) + (closed_ ? 0 : 1);
}

const Waypoint& CameraPath::control(int index) const {
  const int count = static_cast<int>(waypoints_.size());
  if (closed_) return waypoints_[static_cast<std::size_t>(((index % count) + count) % count)];
  return waypoints_[static_cast<std::size_t>(std::clamp(index - 1, 0, count - 1))];
}

Pose CameraPath::pose_at(double u) const {
  const double place = closed_ ? u - end() * std::floor(u / end()) : std::clamp(u, 0.0, end());
  const int segment = std::min(static_cast<int>(place), static_cast<int>(end()) - 1);
  const std::array<double, 4> weights = spline_weights(place - segment);
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (int i = 0; i < 4; ++i) {
    const Waypoint& waypoint = control(segment + i - 1);
    position += weights[static_cast<std::size_t>(i)] * waypoint.position_m;
    direction += weights[static_cast<std::size_t>(i)] * waypoint.direction.normalized();
  }
  return look_along(position, direction);
}

CameraMotion plan_motion(const CameraPath& path, const MotionLimits& limits, int frames,
                         int min_frames, double frame_rate_hz,
                         const std::vector<double>& delay_shares) {
  if (path.empty()) throw UsageError("the path of the camera has no poses");
  const EffortTable efforts(path, limits);
  const int needed = static_cast<int>(std::ceil(efforts.total() / limit_share)) + 1;
  const int count = frames > 0 ? frames : std::max(needed, min_frames);
  const double step = count > 1 ? std::min(limit_share, efforts.total() / (count - 1)) : 0;
  CameraMotion motion;
  for (const double delay_share : delay_shares) {
    Trajectory& poses = motion.at.emplace_back();
    for (int i = 0; i < count; ++i) {
      poses.push_back({i / frame_rate_hz, path.pose_at(efforts.place((i + delay_share) * step))});
    }
    if (!path.closed() && count > 1 && delay_share > 0 &&
        (count - 1 + delay_share) * step > efforts.total()) {
      // An open path ends at the last frame. The pose of a later image of it is extrapolated from
      // the last step.
      const Pose before = path.pose_at(efforts.place((count - 2) * step));
      const Pose last = path.pose_at(efforts.place((count - 1) * step));
      poses.back().world_from_camera = interpolate(before, last, 1 + delay_share);
    }
  }
  return motion;
}

CameraMotion replay_motion(const Trajectory& poses, int frames,
                           const std::vector<double>& delay_shares) {
  if (poses.empty()) throw UsageError("the trajectory contains no poses to replay");
  const std::size_t count =
      frames > 0 ? std::min(poses.size(), static_cast<std::size_t>(frames)) : poses.size();
  CameraMotion motion;
  for (const double delay_share : delay_shares) {
    Trajectory& at_image = motion.at.emplace_back();
    for (std::size_t i = 0; i < count; ++i) {
      at_image.push_back(poses[i]);
      if (poses.size() == 1) break;
      if (delay_share == 0) continue;
      const bool last = i + 1 == poses.size();
      const Pose& from = poses[last ? i - 1 : i].world_from_camera;
      const Pose& to = poses[last ? i : i + 1].world_from_camera;
      at_image.back().world_from_camera = interpolate(from, to, delay_share + (last ? 1 : 0));
    }
  }
  return motion;
}

}  // namespace tofmap
