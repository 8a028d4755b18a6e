// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// An organised cloud with normals whose pose is known. The cloud must outlive its use.
struct RegistrationTarget {
  const SurfaceCloud* cloud = nullptr;  ///< in the frame of the camera that took it
  Pose world_from_camera = Pose::Identity();
};

/// What motion alone lets expect: where the camera should be, and how far it may be off.
struct MotionPrior {
  Pose world_from_camera = Pose::Identity();
  double rotation_sigma_rad = 0;   ///< must be positive
  double translation_sigma_m = 0;  ///< must be positive
};

/// How many standard deviations of the prior the pose is off, the worse of turn and step.
double deviation(const MotionPrior& prior, const Pose& world_from_camera);

struct RegistrationOptions {
  std::string method = "projective";
  int source_stride_px = 2;
  int max_iterations = 20;
  double max_correspondence_distance_m = 0.4;
  double max_normal_angle_rad = 0.8;
  double kernel_width = 3;
  double systematic_sigma_m = 0.003;
  double correlated_observations = 12;
  int min_correspondences = 200;
  double min_overlap = 0.15;
  double min_inlier_ratio = 0.5;

  static std::vector<OptionField<RegistrationOptions>> fields();
};

enum class RegistrationStatus {
  converged,        ///< the last step was below the tolerance
  iteration_limit,  ///< still moving at max_iterations; the pose may be used with care
  few_correspondences,
  low_overlap,  ///< too small a share of the source fell onto the targets
  low_inliers,  ///< too many correspondences disagree with the pose
};

/// Whether the pose may be used.
bool succeeded(RegistrationStatus status);
const char* status_name(RegistrationStatus status);

struct RegistrationResult {
  RegistrationStatus status = RegistrationStatus::few_correspondences;
  Pose world_from_camera = Pose::Identity();
  int iterations = 0;  ///< with all points
  int correspondences = 0;
  double overlap = 0;         ///< share of the source's points with a correspondence
  double inlier_ratio = 0;    ///< share of correspondences the kernel keeps at half weight or more
  double rmse_m = 0;          ///< point-to-plane, over those inliers
  double residual_scale = 0;  ///< robust standard deviation of residuals over predicted noise

  /// Of the twist (rotation vector about the camera's centre, radians; translation, metres)
  /// in world axes, prior included.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  /// Of the same twist, without the prior: the inverse of what its covariance would be. Nothing in
  /// degenerate directions.
  Eigen::Matrix<double, 6, 6> surface_information = Eigen::Matrix<double, 6, 6>::Zero();

  /// How many of the six directions of motion the surfaces say less of than the prior does: they
  /// are left to it.
  int degenerate_directions = 0;
  /// Shares of the observations that constrain each direction, ascending: 0 (free) … 1, rotations
  /// measured at the source's typical range.
  Eigen::Matrix<double, 6, 1> direction_shares = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Finds the pose of an organised cloud by projecting it into clouds of known pose and
/// minimising distances from points to the planes they fall on (Chen and Medioni 1991, with
/// the projective search of Blais and Levine 1995).
///
/// Gauss-Newton in double precision about the camera's centre, with a quarter of the points at
/// first. Each correspondence is
/// weighted by the inverse of its predicted variance (noise of both points along the normal,
/// plus `systematic_sigma_m`) and by a Geman-McClure kernel whose width is kernel_width times
/// the robust scale of the residuals. The prior has its say in every direction of motion by its
/// standard deviations, and decides alone on those of which the surfaces say less. `camera` took
/// source and targets. The result is the same for any number of threads.
///
/// With the methods `pcl_icp` and `pcl_gicp` the pose is what PCL's algorithms make of the same
/// points from the same start, for comparison; all else is measured at that pose.
RegistrationResult register_to_targets(const SurfaceCloud& source,
                                       std::span<const RegistrationTarget> targets,
                                       const CameraModel& camera, const MotionPrior& prior,
                                       const RegistrationOptions& options);

/// Share of the source's points that fall onto a target's surface at a given pose: a cheap
/// measure of how much both see of the same.
double overlap_share(const SurfaceCloud& source, const Pose& world_from_source,
                     const RegistrationTarget& target, const CameraModel& camera,
                     const RegistrationOptions& options);

}  // namespace tofmap
