// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// An organised cloud with normals whose pose is known. The cloud must outlive the target, unless
/// the target keeps it.
struct RegistrationTarget {
  const SurfaceCloud* cloud = nullptr;  ///< in the frame of the camera that took it; not null
  Pose world_from_camera = Pose::Identity();
  std::shared_ptr<const SurfaceCloud> kept = nullptr;  ///< `cloud`, or null
};

/// The pose that a motion model predicts, and its uncertainty, the same along all axes.
struct MotionPrior {
  Pose world_from_camera = Pose::Identity();
  double rotation_sigma_rad = 0;   ///< standard deviation per axis; must be positive
  double translation_sigma_m = 0;  ///< standard deviation per axis; must be positive
};

/// Difference between a pose and the predicted one, divided by the prior's standard deviations:
/// the larger value of rotation and translation.
double prior_deviation_sigmas(const MotionPrior& prior, const Pose& world_from_camera);

/// How frames are registered.
enum class RegistrationMethod {
  projective,  ///< point-to-plane ICP with projective search, as register_to_targets() describes
  pcl_icp,     ///< PCL's IterativeClosestPoint, for comparison
  pcl_gicp,    ///< PCL's GeneralizedIterativeClosestPoint, for comparison
};

/// The names of all methods, the recommended one first.
std::span<const NamedValue<RegistrationMethod>> named_values(RegistrationMethod);

/// Options of register_to_targets().
struct RegistrationOptions {
  RegistrationMethod method = RegistrationMethod::projective;
  /// Registers every n-th pixel of a frame in both axes, 1 … 16.
  int source_stride_px = 2;
  /// Largest number of Gauss-Newton iterations, 1 … 200, of the coarse and of the fine stage each.
  int max_iterations = 20;
  /// Largest correspondence distance, 0.01 … 5 m. Points farther apart are not paired.
  double max_correspondence_distance_m = 0.4;
  /// Largest angle between the normals of a correspondence, 0.01 … 1.57 rad.
  double max_normal_angle_rad = 0.8;
  /// Width of the Geman-McClure kernel in robust standard deviations of the residuals, 0.5 … 100. A
  /// smaller width down-weights outliers more strongly.
  double kernel_width = 3;
  /// Standard deviation of the error of a point that averaging does not reduce, 0 … 1 m. Its square
  /// is added to the predicted variance of each correspondence.
  double systematic_sigma_m = 0.003;
  /// Number of correspondences that count as one independent observation, 1 … 1000. A larger number
  /// increases the covariance and the weight of the prior.
  double correlated_observations = 12;
  /// Smallest number of correspondences of a registered frame, 6 … 1000000.
  int min_correspondences = 200;
  /// Smallest share of a frame's points that must have a correspondence, 0 … 1.
  double min_overlap = 0.15;
  /// Smallest share of the correspondences that must fit the pose, 0 … 1.
  double min_inlier_ratio = 0.5;

  static std::vector<OptionField<RegistrationOptions>> fields();
};

/// How a registration ended.
enum class RegistrationStatus {
  converged,            ///< the last increment was below the tolerance
  iteration_limit,      ///< still moving at max_iterations; the pose may be used with care
  few_correspondences,  ///< fewer than min_correspondences, or no source points or targets
  low_overlap,          ///< less than min_overlap of the source has a correspondence
  low_inliers,          ///< less than min_inlier_ratio of the correspondences fit the pose
};

/// Whether the pose may be used: true for `converged` and `iteration_limit`.
bool succeeded(RegistrationStatus status);
std::span<const NamedValue<RegistrationStatus>> named_values(RegistrationStatus);

/// How a registration ended, and how well the pose fits.
struct RegistrationFigures {
  RegistrationStatus status = RegistrationStatus::few_correspondences;
  int iterations = 0;         ///< of the fine stage, which uses all points
  int correspondences = 0;    ///< in the last iteration
  double overlap = 0;         ///< share of the source's points with a correspondence
  double inlier_ratio = 0;    ///< share of correspondences whose kernel weight is at least one half
  double rmse_m = 0;          ///< RMS distance from point to plane over those inliers, metres
  double residual_scale = 0;  ///< robust ratio of residuals to predicted noise, at least 1
  /// Number of degenerate directions of motion, of six: those in which the surfaces give less
  /// information than the prior, without what is noise-induced. Along these, the pose depends on
  /// the prior more than on the surfaces.
  int degenerate_directions = 0;
};

/// What the correspondences with one target tell about a small correction of the source's pose, a
/// twist as for RegistrationResult::covariance: of that target alone, it would be −information⁻¹ ·
/// gradient. Without what is noise-induced, so that sums over many frames are not biased; along
/// directions that the surfaces hardly constrain, the information of a single frame is noise, and
/// may be negative.
struct TargetEquations {
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
};

/// The pose that register_to_targets() found, and how well it fits.
struct RegistrationResult : RegistrationFigures {
  Pose world_from_camera = Pose::Identity();  ///< to be used only if the registration succeeded()

  /// Covariance of the pose error as a twist: rotation vector about the camera's centre, radians,
  /// then translation, metres, both along the world's axes. Includes the prior.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  /// Information (inverse covariance) about the same twist relative to each target, from its
  /// surfaces alone, without the prior, other targets, and the noise of normals. Zero along
  /// degenerate directions. A target gives no information about a direction of motion that its
  /// surfaces do not constrain, even if those of another target do. Empty if too few
  /// correspondences were found.
  std::vector<Eigen::Matrix<double, 6, 6>> target_information;

  /// The equations of each target at the pose of the last iteration. Empty if too few
  /// correspondences were found.
  std::vector<TargetEquations> target_equations;

  /// Share of the observations that constrain each direction of motion, in ascending order, from 0
  /// (unconstrained) to 1. Rotations are measured as the motion of points at the median range of
  /// the source.
  Eigen::Matrix<double, 6, 1> direction_shares = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Whether a registration took more than 60 % of the iterations that the options allow. Then its
/// surfaces hardly constrain some direction of motion: correspondences slide along it with the
/// source, and the error of the pose may be larger than its covariance says.
bool converged_slowly(const RegistrationFigures& figures, const RegistrationOptions& options);

/// Finds the pose of an organised cloud by projecting its points into clouds of known pose and
/// minimising the distances from the points to the planes that they fall on (Chen and Medioni 1991,
/// with the projective search of Blais and Levine 1995). `camera` is the camera that took the
/// source and all targets.
///
/// Gauss-Newton in double precision about the camera's centre: a coarse stage with a quarter of the
/// points, then a fine stage with all of them. Each correspondence is weighted by the inverse of
/// its predicted variance (noise of both points along the normal, plus the square of
/// `systematic_sigma_m`), by the confidence of both points, and by a Geman-McClure kernel whose
/// width is `kernel_width` times the robust scale of the residuals. The prior contributes to every
/// direction of motion by its standard deviations, and the surfaces by their information without
/// what comes from the noise of normals alone. The result is the same for any number of threads.
///
/// With the methods `pcl_icp` and `pcl_gicp`, PCL finds the pose from the same points and the same
/// initial pose, for comparison. The status is `converged` if PCL reports convergence, which
/// includes its iteration limit, and the overlap and the inlier ratio are large enough. All other
/// values of the result are measured at PCL's pose.
///
/// Throws UsageError if a standard deviation of the prior is not positive. The status
/// of the result tells whether registration succeeded.
RegistrationResult register_to_targets(const SurfaceCloud& source,
                                       std::span<const RegistrationTarget> targets,
                                       const CameraModel& camera, const MotionPrior& prior,
                                       const RegistrationOptions& options);

/// Share of the source's points that have a correspondence in a target at a given pose, measured at
/// every eighth pixel in both axes: a cheap estimate of how much of the source the target sees. 0
/// if the source has no points.
double overlap_share(const SurfaceCloud& source, const Pose& world_from_source,
                     const RegistrationTarget& target, const CameraModel& camera,
                     const RegistrationOptions& options);

/// What a registration with a target would tell about the pose of a source.
struct TargetPreview {
  double overlap = 0;  ///< as overlap_share()
  /// As RegistrationResult::target_information, for residuals as large as predicted, but not zero
  /// along degenerate directions.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
};

/// Estimates what a registration with a target would tell about the pose, from every eighth pixel
/// in both axes at a pose that is nearly right. All values are 0 if the source has no points.
TargetPreview preview_target(const SurfaceCloud& source, const Pose& world_from_source,
                             const RegistrationTarget& target, const CameraModel& camera,
                             const RegistrationOptions& options);

}  // namespace tofmap
