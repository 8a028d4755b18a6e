// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

namespace tofmap {

/// A rigid motion. Transforms are named so that adjacent names in a product cancel:
/// world_from_b = world_from_a * a_from_b.
using Pose = Eigen::Isometry3d;

/// The pose of the camera at one time.
struct StampedPose {
  double timestamp_s = 0;
  Pose world_from_camera = Pose::Identity();  ///< from the optical frame to the world, metres
};

using Trajectory = std::vector<StampedPose>;

/// Angle of the rotation between two poses, 0 … π.
double rotation_angle_rad(const Pose& a, const Pose& b);

/// The motion x ↦ exp([ω]×) x + t of a six-vector (ω, t): rotation vector in radians, translation
/// in metres. This is a retraction that agrees with the exponential map of SE(3) to first order; t
/// is the translation itself.
Pose pose_from_twist(const Eigen::Matrix<double, 6, 1>& twist);

/// The twist from one pose to another, along the axes of the world: the rotation vector of the turn
/// between their orientations, and the difference of their translations.
Eigen::Matrix<double, 6, 1> twist_between(const Pose& from, const Pose& to);

/// The pose that is a twist away: twist_between(from, moved_by(twist, from)) is `twist`.
Pose moved_by(const Eigen::Matrix<double, 6, 1>& twist, const Pose& from);

/// Interpolates between two poses: linearly in translation, spherically in rotation. `share` 0
/// gives `a`, 1 gives `b`; values outside 0 … 1 extrapolate.
Pose interpolate(const Pose& a, const Pose& b, double share);

/// A pose whose timestamp differs from that of a frame by more than this does not belong to the
/// frame. It is half a frame period at 25 Hz.
inline constexpr double max_pose_gap_s = 0.02;

/// The pose at a time. Interpolates between the last pose before that time and the first one after
/// it if both are within `max_gap_s` of it. If only one of them is, returns that pose; if neither
/// is, the result is empty. The trajectory need not be sorted.
std::optional<Pose> pose_at(const Trajectory& trajectory, double timestamp_s,
                            double max_gap_s = max_pose_gap_s);

/// Reads a trajectory in the format of the TUM RGB-D benchmark: one pose per line, `timestamp tx ty
/// tz qx qy qz qw`; lines that start with # are comments. Throws InputError, which names file and
/// line, if a line does not hold eight numbers, if its quaternion is zero, or if a coordinate
/// exceeds 1e8 m. Throws InputError if the file cannot be read.
Trajectory read_trajectory(const std::filesystem::path& file);

/// The usable part of a trajectory file.
struct UsableTrajectory {
  Trajectory poses;
  /// One message for each line that was left out: file, line number, and what is wrong.
  std::vector<std::string> damages;
};

/// Reads a trajectory in the format of read_trajectory(), but leaves out the lines that
/// read_trajectory() would refuse. Throws InputError if the file cannot be read.
UsableTrajectory read_usable_trajectory(const std::filesystem::path& file);

/// Writes one pose as a line in the format of read_trajectory(): six decimals for the timestamp,
/// nine for the pose. The caller checks the state of the stream.
void write_pose(std::ostream& out, const StampedPose& pose);

/// Writes a trajectory in the format of read_trajectory(). Throws InputError if the file cannot be
/// written.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace tofmap
