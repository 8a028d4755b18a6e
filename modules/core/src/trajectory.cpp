// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {

double rotation_angle_rad(const Pose& a, const Pose& b) {
  return Eigen::Quaterniond(a.linear()).angularDistance(Eigen::Quaterniond(b.linear()));
}

Pose pose_from_twist(const Eigen::Matrix<double, 6, 1>& twist) {
  const Eigen::Vector3d rotation = twist.head<3>();
  const double angle = rotation.norm();
  Pose pose = Pose::Identity();
  if (angle > 0) pose.linear() = Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  pose.translation() = twist.tail<3>();
  return pose;
}

Eigen::Matrix<double, 6, 1> twist_between(const Pose& from, const Pose& to) {
  const Eigen::AngleAxisd rotation(to.linear() * from.linear().transpose());
  Eigen::Matrix<double, 6, 1> twist;
  twist << rotation.angle() * rotation.axis(), to.translation() - from.translation();
  return twist;
}

Pose moved_by(const Eigen::Matrix<double, 6, 1>& twist, const Pose& from) {
  Pose moved = pose_from_twist(twist);
  moved.linear() = (moved.linear() * from.linear()).eval();
  moved.translation() += from.translation();
  return moved;
}

Pose interpolate(const Pose& a, const Pose& b, double share) {
  const Eigen::Quaterniond qa(a.linear());
  const Eigen::AngleAxisd step(qa.conjugate() * Eigen::Quaterniond(b.linear()));
  Pose pose = Pose::Identity();
  pose.linear() = (qa * Eigen::AngleAxisd(share * step.angle(), step.axis())).toRotationMatrix();
  pose.translation() = (1 - share) * a.translation() + share * b.translation();
  return pose;
}

std::optional<Pose> pose_at(const Trajectory& trajectory, double timestamp_s, double max_gap_s) {
  const StampedPose* before = nullptr;
  const StampedPose* after = nullptr;
  for (const StampedPose& pose : trajectory) {
    if (std::abs(pose.timestamp_s - timestamp_s) > max_gap_s) continue;
    if (pose.timestamp_s <= timestamp_s) {
      if (before == nullptr || pose.timestamp_s > before->timestamp_s) before = &pose;
    } else if (after == nullptr || pose.timestamp_s < after->timestamp_s) {
      after = &pose;
    }
  }
  if (before == nullptr && after == nullptr) return std::nullopt;
  if (before == nullptr) return after->world_from_camera;
  if (after == nullptr) return before->world_from_camera;
  const double share =
      (timestamp_s - before->timestamp_s) / (after->timestamp_s - before->timestamp_s);
  return interpolate(before->world_from_camera, after->world_from_camera, share);
}

namespace {

/// Larger coordinates are certainly not in metres: no place on Earth is that far from any origin in
/// use.
constexpr double farthest_m = 1e8;

/// Parses a line of a trajectory file. Empty if the line is not a pose.
std::optional<StampedPose> parse_pose(const std::string& line) {
  std::istringstream fields(line);
  StampedPose pose;
  Eigen::Vector3d t;
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 0;
  fields >> pose.timestamp_s >> t.x() >> t.y() >> t.z() >> x >> y >> z >> w;
  const Eigen::Quaterniond q(w, x, y, z);
  const bool has_eight = !fields.fail() && (fields >> std::ws).eof();
  const bool is_near = t.cwiseAbs().maxCoeff() <= farthest_m;  // false for NaN as well
  // Normalises a quaternion whose length is off by rounding; a zero quaternion is no rotation.
  if (!has_eight || !is_near || !std::isfinite(q.norm()) || q.norm() < 1e-3) return std::nullopt;
  pose.world_from_camera.linear() = q.normalized().toRotationMatrix();
  pose.world_from_camera.translation() = t;
  return pose;
}

}  // namespace

UsableTrajectory read_usable_trajectory(const std::filesystem::path& file) {
  refuse_no_file(file);
  std::ifstream in(file);
  if (!in) throw InputError(file.string() + ": cannot be read; does it exist?");
  UsableTrajectory usable;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    const std::size_t first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos || line[first] == '#') continue;
    if (const auto pose = parse_pose(line)) {
      usable.poses.push_back(*pose);
      continue;
    }
    constexpr std::size_t most_shown = 200;
    usable.damages.push_back(file.string() + ":" + std::to_string(number) +
                             ": expected 'timestamp tx ty tz qx qy qz qw', got '" +
                             line.substr(0, most_shown) + "'");
  }
  return usable;
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  UsableTrajectory usable = read_usable_trajectory(file);
  if (!usable.damages.empty()) throw InputError(usable.damages.front());
  return std::move(usable.poses);
}

void write_pose(std::ostream& out, const StampedPose& pose) {
  const Eigen::Vector3d t = pose.world_from_camera.translation();
  const Eigen::Quaterniond q(pose.world_from_camera.linear());
  out << std::fixed << std::setprecision(6) << pose.timestamp_s << std::setprecision(9);
  for (const double value : {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()}) out << ' ' << value;
  out << '\n';
}

void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory) {
  std::ofstream out(file);
  out << "# timestamp tx ty tz qx qy qz qw\n";
  for (const StampedPose& pose : trajectory) write_pose(out, pose);
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

}  // namespace tofmap
