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

/// A rigid motion in double precision. Transforms are named so that products read by
/// cancelling: world_from_b = world_from_a * a_from_b.
using Pose = Eigen::Isometry3d;

/// Where the camera was: camera (optical frame) to world, metres.
struct StampedPose {
  double timestamp_s = 0;
  Pose world_from_camera = Pose::Identity();
};

using Trajectory = std::vector<StampedPose>;

/// Angle of the rotation between two poses, radians, 0 … π.
double rotation_angle_rad(const Pose& a, const Pose& b);

/// The motion exp(ξ) of a twist ξ = (rotation vector in radians, translation in metres):
/// rotation by the vector, then translation; the first-order model of the registration.
Pose pose_from_twist(const Eigen::Matrix<double, 6, 1>& twist);

/// Linear in translation, spherical in rotation; `share` 0 gives `a`, 1 gives `b`.
/// Outside 0 … 1 it extrapolates.
Pose interpolate(const Pose& a, const Pose& b, double share);

/// A pose that far from a frame in time is none of it: half a frame of a slow camera.
inline constexpr double max_pose_gap_s = 0.02;

/// The pose at a time: between the last one before and the first one after it if both are within
/// `max_gap_s`, else the one that is; nothing if neither is. The trajectory is in any order.
std::optional<Pose> pose_at(const Trajectory& trajectory, double timestamp_s,
                            double max_gap_s = max_pose_gap_s);

/// Reads a trajectory in the form of the TUM RGB-D benchmark: a line a pose, `timestamp tx ty tz
/// qx qy qz qw`, # starts a comment. Throws InputError that names file and line if a line
/// does not hold eight numbers, its quaternion is zero, or it is farther than 1e8 m from the
/// origin.
Trajectory read_trajectory(const std::filesystem::path& file);

/// What of a trajectory file can be used.
struct UsableTrajectory {
  Trajectory poses;
  std::vector<std::string> damages;  ///< of each line that is left out: file, number, what is wrong
};

/// Reads the same form, and leaves out the lines that read_trajectory would refuse. Throws
/// InputError if the file cannot be read at all.
UsableTrajectory read_usable_trajectory(const std::filesystem::path& file);

/// Writes one line of that form; the caller checks the stream.
void write_pose(std::ostream& out, const StampedPose& pose);

/// Writes that form: six decimals for the time, nine for the pose. Throws InputError if the
/// file cannot be written.
void write_trajectory(const std::filesystem::path& file, const Trajectory& trajectory);

}  // namespace tofmap
