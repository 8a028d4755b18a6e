// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/projective_icp.hpp"

#include "correspondences.hpp"
#include "normal_equations.hpp"
#include "pcl_alignment.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/Cholesky>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

constexpr double rotation_tolerance_rad = 2e-5;
constexpr double translation_tolerance_m = 5e-5;

/// Tolerance of the coarse stage in multiples of the final one. The fine stage corrects the rest.
constexpr double coarse_tolerance = 20;
constexpr int coarse_stride = 2;

/// Overlaps are measured at every n-th pixel in both axes.
constexpr int sparse_stride_px = 8;

bool is_below_tolerance(const Vector6d& twist, double tolerances) {
  return twist.head<3>().norm() < tolerances * rotation_tolerance_rad &&
         twist.tail<3>().norm() < tolerances * translation_tolerance_m;
}

/// The pose after a rotation about the camera's centre and a translation, both along the world's
/// axes: the inverse of twist_between().
Pose moved(const Pose& world_from_camera, const Vector6d& twist) {
  const Pose step = pose_from_twist(twist);
  Pose pose = world_from_camera;
  pose.linear() = step.linear() * world_from_camera.linear();
  pose.translation() += step.translation();
  return pose;
}

double median_range_m(const std::vector<const SurfacePoint*>& points) {
  std::vector<float> ranges(points.size());
  std::ranges::transform(points, ranges.begin(),
                         [](const SurfacePoint* point) { return point->getVector3fMap().norm(); });
  return median(ranges);
}

/// The standard deviations of a prior in the order of a twist.
Vector6d prior_sigmas(const MotionPrior& prior) {
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(prior.rotation_sigma_rad),
      Eigen::Vector3d::Constant(prior.translation_sigma_m);
  return sigmas;
}

/// The Gauss-Newton system at one pose.
struct System {
  NormalEquations equations;               ///< of all targets and the prior
  std::vector<NormalEquations> of_target;  ///< of each target alone, as it is observed
  ResidualStatistics statistics;
  Observability seen;
  std::vector<int> degenerate;  ///< directions, as columns of `seen.directions`
};

/// Points whose plane fits share pixels are not independent observations, and residuals above the
/// predicted noise mean that there is less information than predicted.
void count_independent(NormalEquations& equations, double independent) {
  equations.information *= independent;
  equations.gradient *= independent;
  equations.weight_sum *= independent;
  equations.noise_induced *= independent;
}

/// The equations of the correspondences with each target.
std::vector<NormalEquations> equations_by_target(const Correspondences& found,
                                                 double kernel_width) {
  std::vector<std::span<const Correspondence>> pairs;
  std::span<const Correspondence> rest = found.pairs;
  for (const std::size_t count : found.of_target) {
    pairs.push_back(rest.first(count));
    rest = rest.subspan(count);
  }
  std::vector<NormalEquations> equations(pairs.size());
#pragma omp parallel for schedule(dynamic, 1) if (found.pairs.size() > enough_for_threads)
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    equations[i] = build_equations(pairs[i], kernel_width);
  }
  return equations;
}

System build_system(const Correspondences& found, const Pose& pose, double lever_m,
                    const MotionPrior& prior, const RegistrationOptions& options) {
  System system;
  const double scale = robust_scale(found.pairs);
  const double kernel_width = options.kernel_width * scale;
  const double independent = 1 / (options.correlated_observations * scale * scale);
  system.statistics = residual_statistics(found.pairs, scale, kernel_width);
  system.of_target = equations_by_target(found, kernel_width);
  for (NormalEquations& of_target : system.of_target) {
    count_independent(of_target, independent);
    system.equations += of_target;
  }
  system.seen = observability(system.equations, lever_m);
  const Vector6d sigmas = prior_sigmas(prior);
  keep_shares(system.equations, system.seen, surface_shares(system.seen, system.equations));
  system.degenerate = degenerate_directions(system.seen, system.equations.information, sigmas);
  add_prior(system.equations, twist_between(pose, prior.world_from_camera), sigmas);
  return system;
}

/// The information that surfaces give, without the noise-induced part.
Matrix6d surface_information(NormalEquations equations, double lever_m) {
  const Observability seen = observability(equations, lever_m);
  keep_shares(equations, seen, surface_shares(seen, equations));
  return equations.information;
}

/// The information about the pose relative to each target, from the correspondences with that
/// target alone. There is none along directions that are degenerate with all of them.
std::vector<Matrix6d> information_by_target(const System& system, double lever_m) {
  Vector6d not_degenerate = Vector6d::Ones();
  for (const int i : system.degenerate) not_degenerate[i] = 0;
  std::vector<Matrix6d> information;
  for (NormalEquations equations : system.of_target) {
    keep_shares(equations, system.seen, not_degenerate);
    information.push_back(surface_information(equations, lever_m));
  }
  return information;
}

RegistrationStatus verdict(const RegistrationResult& result, bool has_converged,
                           const RegistrationOptions& options) {
  if (result.overlap < options.min_overlap) return RegistrationStatus::low_overlap;
  if (result.inlier_ratio < options.min_inlier_ratio) return RegistrationStatus::low_inliers;
  return has_converged ? RegistrationStatus::converged : RegistrationStatus::iteration_limit;
}

/// Gauss-Newton iterations from the pose of `result`, which is updated, until an increment is below
/// the tolerance times `tolerances`.
RegistrationStatus descend(const std::vector<const SurfacePoint*>& points,
                           std::span<const RegistrationTarget> targets, const CameraModel& camera,
                           const MotionPrior& prior, const RegistrationOptions& options,
                           double tolerances, RegistrationResult& result) {
  const double lever_m = median_range_m(points);
  bool has_converged = false;
  System system;
  while (result.iterations < options.max_iterations && !has_converged) {
    const Correspondences found =
        find_correspondences(points, result.world_from_camera, targets, camera, options);
    result.correspondences = static_cast<int>(found.pairs.size());
    if (result.correspondences < options.min_correspondences) {
      return RegistrationStatus::few_correspondences;
    }
    system = build_system(found, result.world_from_camera, lever_m, prior, options);
    const Eigen::LDLT<Matrix6d> solver(system.equations.information);
    const Vector6d twist = -solver.solve(system.equations.gradient);
    result.world_from_camera = moved(result.world_from_camera, twist);
    result.covariance = solver.solve(Matrix6d::Identity());
    result.overlap = found.overlap;
    result.inlier_ratio = system.statistics.inlier_ratio;
    result.rmse_m = system.statistics.rmse_m;
    result.residual_scale = system.statistics.scale;
    result.direction_shares = system.seen.shares;
    result.degenerate_directions = static_cast<int>(system.degenerate.size());
    has_converged = is_below_tolerance(twist, tolerances);
    ++result.iterations;
  }
  result.target_information = information_by_target(system, lever_m);
  for (const NormalEquations& of_target : system.of_target) {
    result.target_equations.push_back(
        {of_target.information - of_target.noise_induced, of_target.gradient});
  }
  return verdict(result, has_converged, options);
}

/// Coarse to fine: converges roughly with a quarter of the points, then precisely with all of them.
RegistrationStatus refine(const SurfaceCloud& source,
                          const std::vector<const SurfacePoint*>& points,
                          std::span<const RegistrationTarget> targets, const CameraModel& camera,
                          const MotionPrior& prior, const RegistrationOptions& options,
                          RegistrationResult& result) {
  RegistrationOptions coarse = options;
  coarse.source_stride_px *= coarse_stride;
  coarse.min_correspondences /= coarse_stride * coarse_stride;
  const auto fewer_points = select_points(source, coarse.source_stride_px);
  if (!fewer_points.empty()) {
    const RegistrationStatus status =
        descend(fewer_points, targets, camera, prior, coarse, coarse_tolerance, result);
    if (!succeeded(status)) result.world_from_camera = prior.world_from_camera;
  }
  const Pose start = result.world_from_camera;
  result = {};  // all else is of the fine stage
  result.world_from_camera = start;
  constexpr double one = 1;
  return descend(points, targets, camera, prior, options, one, result);
}

/// Positions of points of a camera in another frame.
std::vector<Eigen::Vector3f> positions(const std::vector<const SurfacePoint*>& points,
                                       const Pose& frame_from_camera) {
  const Eigen::Isometry3f pose = frame_from_camera.cast<float>();
  std::vector<Eigen::Vector3f> out(points.size());
  std::ranges::transform(points, out.begin(), [&](const SurfacePoint* point) -> Eigen::Vector3f {
    return pose * point->getVector3fMap();
  });
  return out;
}

/// Replaces the pose of `result` by the one that PCL finds, then measures the fit there with one
/// iteration of `descend`, whose increment is discarded.
RegistrationStatus refine_with_pcl(const SurfaceCloud&,
                                   const std::vector<const SurfacePoint*>& points,
                                   std::span<const RegistrationTarget> targets,
                                   const CameraModel& camera, const MotionPrior& prior,
                                   const RegistrationOptions& options, RegistrationResult& result) {
  // PCL computes in floats, so coordinates are relative to the predicted camera.
  const Pose& origin = prior.world_from_camera;
  std::vector<Eigen::Vector3f> surface;
  for (const RegistrationTarget& target : targets) {
    const auto chosen = select_points(*target.cloud, options.source_stride_px);
    std::ranges::copy(positions(chosen, origin.inverse() * target.world_from_camera),
                      std::back_inserter(surface));
  }
  const PclAlignment found =
      align_with_pcl(positions(points, Pose::Identity()), surface, Pose::Identity(),
                     options.max_correspondence_distance_m,
                     options.method == RegistrationMethod::pcl_gicp, options.max_iterations);
  result.world_from_camera = origin * found.target_from_source;
  RegistrationOptions just_measure = options;
  just_measure.max_iterations = 1;
  result.iterations = 0;
  const Pose pose = result.world_from_camera;
  const RegistrationStatus status =
      descend(points, targets, camera, prior, just_measure, 1, result);
  result.world_from_camera = pose;
  if (!succeeded(status)) return status;
  return found.converged ? RegistrationStatus::converged : RegistrationStatus::iteration_limit;
}

}  // namespace

std::span<const NamedValue<RegistrationMethod>> named_values(RegistrationMethod) {
  static constexpr std::array<NamedValue<RegistrationMethod>, 3> methods{
      {{"projective", RegistrationMethod::projective},
       {"pcl_icp", RegistrationMethod::pcl_icp},
       {"pcl_gicp", RegistrationMethod::pcl_gicp}}};
  return methods;
}

std::vector<OptionField<RegistrationOptions>> RegistrationOptions::fields() {
  using O = RegistrationOptions;
  return {
      {"method", &O::method, 0, 0, "",
       "how frames are registered; the methods of PCL are for comparison"},
      {"source_stride_px", &O::source_stride_px, 1, 16, "px",
       "registers every n-th pixel of a frame in both axes"},
      {"max_iterations", &O::max_iterations, 1, 200, "",
       "largest number of Gauss-Newton iterations"},
      {"max_correspondence_distance_m", &O::max_correspondence_distance_m, 0.01, 5, "m",
       "largest distance between the points of a correspondence"},
      {"max_normal_angle_rad", &O::max_normal_angle_rad, 0.01, 1.57, "rad",
       "largest angle between the normals of a correspondence"},
      {"kernel_width", &O::kernel_width, 0.5, 100, "",
       "width of the Geman-McClure kernel, in robust standard deviations of the residuals"},
      {"systematic_sigma_m", &O::systematic_sigma_m, 0, 1, "m",
       "standard deviation of the error of a point that averaging does not reduce; added to its "
       "predicted noise"},
      {"correlated_observations", &O::correlated_observations, 1, 1000, "",
       "number of correspondences that count as one independent observation"},
      {"min_correspondences", &O::min_correspondences, 6, 1000000, "",
       "a frame with fewer correspondences is not registered"},
      {"min_overlap", &O::min_overlap, 0, 1, "",
       "smallest share of a frame's points that must have a correspondence"},
      {"min_inlier_ratio", &O::min_inlier_ratio, 0, 1, "",
       "smallest share of the correspondences that must fit the pose"},
  };
}

double prior_deviation_sigmas(const MotionPrior& prior, const Pose& world_from_camera) {
  const double rotation_rad = rotation_angle_rad(prior.world_from_camera, world_from_camera);
  const double translation_m =
      (prior.world_from_camera.translation() - world_from_camera.translation()).norm();
  return std::max(rotation_rad / prior.rotation_sigma_rad,
                  translation_m / prior.translation_sigma_m);
}

bool succeeded(RegistrationStatus status) {
  return status == RegistrationStatus::converged || status == RegistrationStatus::iteration_limit;
}

std::span<const NamedValue<RegistrationStatus>> named_values(RegistrationStatus) {
  static constexpr std::array<NamedValue<RegistrationStatus>, 5> statuses{
      {{"converged", RegistrationStatus::converged},
       {"iteration_limit", RegistrationStatus::iteration_limit},
       {"few_correspondences", RegistrationStatus::few_correspondences},
       {"low_overlap", RegistrationStatus::low_overlap},
       {"low_inliers", RegistrationStatus::low_inliers}}};
  return statuses;
}

bool converged_slowly(const RegistrationFigures& figures, const RegistrationOptions& options) {
  // Twelve iterations of the twenty by default. Chosen so that frames above it are frequent in
  // recordings with a wrong path, and rare in others: those of benchmarks/troubled_rooms.py with
  // the seeds 11 to 15.
  constexpr double slow_share = 0.6;
  return figures.iterations > slow_share * options.max_iterations;
}

RegistrationResult register_to_targets(const SurfaceCloud& source,
                                       std::span<const RegistrationTarget> targets,
                                       const CameraModel& camera, const MotionPrior& prior,
                                       const RegistrationOptions& options) {
  if (!(prior.rotation_sigma_rad > 0 && prior.translation_sigma_m > 0)) {
    throw UsageError("motion prior: both standard deviations must be positive");
  }
  RegistrationResult result;
  result.world_from_camera = prior.world_from_camera;
  const auto points = select_points(source, options.source_stride_px);
  if (points.empty() || targets.empty()) return result;
  const auto& refine_pose =
      options.method == RegistrationMethod::projective ? refine : refine_with_pcl;
  result.status = refine_pose(source, points, targets, camera, prior, options, result);
  return result;
}

double overlap_share(const SurfaceCloud& source, const Pose& world_from_source,
                     const RegistrationTarget& target, const CameraModel& camera,
                     const RegistrationOptions& options) {
  const auto points = select_points(source, sparse_stride_px);
  if (points.empty()) return 0;
  return find_correspondences(points, world_from_source, {&target, 1}, camera, options).overlap;
}

TargetPreview preview_target(const SurfaceCloud& source, const Pose& world_from_source,
                             const RegistrationTarget& target, const CameraModel& camera,
                             const RegistrationOptions& options) {
  TargetPreview preview;
  const auto points = select_points(source, sparse_stride_px);
  if (points.empty()) return preview;
  const Correspondences found =
      find_correspondences(points, world_from_source, {&target, 1}, camera, options);
  preview.overlap = found.overlap;
  NormalEquations equations = build_equations(found.pairs, options.kernel_width);
  const double points_each = std::pow(sparse_stride_px / double(options.source_stride_px), 2);
  count_independent(equations, points_each / options.correlated_observations);
  preview.information = surface_information(equations, median_range_m(points));
  return preview;
}

}  // namespace tofmap
