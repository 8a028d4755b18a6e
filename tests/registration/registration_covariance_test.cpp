// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// The covariance of a registration against the errors that it makes: the normalised estimation
// error squared (NEES) of a consistent estimator of six unknowns has a chi-squared distribution of
// six degrees of freedom (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).

#include "normal_equations.hpp"
#include "support/box_ranges.hpp"
#include "support/box_room.hpp"
#include "support/consistency.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

const Vector3d covariance_box_min(-1.5, -1.0, -1);
const Vector3d covariance_box_max(2.0, 1.2, 4);
const Pose truth = test::moved_by({0.02, -0.04, 0.03}, {0.05, -0.03, 0.06});
constexpr int draws = 500;

/// The twist that a registration is off by, as its covariance measures twists.
Vector6d error_of(const RegistrationResult& result) {
  return twist_between(truth, result.world_from_camera);
}

RegistrationResult register_clouds(const SurfaceCloud& source, const SurfaceCloud& target,
                                   const RegistrationOptions& options) {
  const std::array<RegistrationTarget, 1> targets{{{&target, Pose::Identity()}}};
  // So wide that the prior's mean does not matter, which is the truth here.
  const MotionPrior prior{truth, 10, 10};
  return register_to_targets(source, targets, test::small_camera(), prior, options);
}

/// The walls of the box without any error, normals included. Pixels that see a wall within
/// `margin_m` of another have no normal: noise may take their points to the other wall.
SurfaceCloud exact_walls(const Pose& world_from_camera, double margin_m) {
  const CameraModel camera = test::small_camera();
  const RangeImage image =
      test::box_ranges(camera, covariance_box_min, covariance_box_max, world_from_camera);
  SurfaceCloud cloud =
      test::box_cloud(camera, covariance_box_min, covariance_box_max, world_from_camera);
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      SurfacePoint& point = cloud.at(u, v);
      const Vector3d in_camera = image.range_m(v, u) * pixel_ray(camera, u, v);
      const Vector3d in_box = world_from_camera * in_camera;
      Eigen::Matrix<double, 6, 1> to_walls;
      to_walls << in_box - covariance_box_min, covariance_box_max - in_box;
      Eigen::Index wall = 0;
      to_walls.minCoeff(&wall);
      Vector3d normal = Vector3d::Zero();
      normal[wall % 3] = wall < 3 ? 1 : -1;
      to_walls[wall] = margin_m;
      if (to_walls.minCoeff() < margin_m) normal.setConstant(NAN);
      point.getVector3fMap() = in_camera.cast<float>();
      point.getNormalVector3fMap() =
          (world_from_camera.linear().transpose() * normal).cast<float>();
      point.sigma_m = 0;
      point.normal_sigma_rad = 0;
      point.confidence = 1;
    }
  }
  return cloud;
}

/// The normalised error of each draw of independent noise of the source's points.
test::Consistency consistency_of_points(const RegistrationOptions& options, float sigma_m) {
  const SurfaceCloud target = exact_walls(Pose::Identity(), 0);
  const SurfaceCloud without_noise = exact_walls(truth, 6 * sigma_m);
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, sigma_m);
  test::Consistency consistency;
  for (int draw = 0; draw < draws; ++draw) {
    SurfaceCloud source = without_noise;
    for (SurfacePoint& point : source) {
      point.sigma_m = sigma_m;
      point.getVector3fMap() += noise(random) * point.getVector3fMap().normalized();
    }
    const RegistrationResult result = register_clouds(source, target, options);
    EXPECT_TRUE(succeeded(result.status));
    consistency.add(error_of(result), result.covariance);
  }
  return consistency;
}

RegistrationOptions options_of_independent_points() {
  RegistrationOptions options;
  options.correlated_observations = 1;
  options.systematic_sigma_m = 0;
  return options;
}

/// By how much the covariance of an M-estimator that takes the kernel's weights for those of least
/// squares is too large for Gaussian residuals r: E[w] E[(w r)²] / E[(w r)']² (Huber 1981, section
/// 7.6, over the E[w]⁻¹ that normal equations have), by the trapezoidal rule.
double predicted_nees_share(double kernel_width) {
  constexpr double step = 1e-3;
  double mean_weight = 0;
  double mean_square = 0;
  double mean_slope = 0;
  for (double r = -8; r < 8; r += step) {
    const double density = std::exp(-r * r / 2) / std::sqrt(2 * std::numbers::pi);
    const auto influence = [&](double x) { return geman_mcclure_weight(x, kernel_width) * x; };
    mean_weight += step * density * geman_mcclure_weight(r, kernel_width);
    mean_square += step * density * std::pow(influence(r), 2);
    mean_slope += step * density * (influence(r + step) - influence(r - step)) / (2 * step);
  }
  return mean_weight * mean_square / std::pow(mean_slope, 2);
}

TEST(RegistrationCovariance, IsThatOfTheErrorsWherePointsAreIndependent) {
  RegistrationOptions options = options_of_independent_points();
  options.kernel_width = 100;  // least squares: no residual is down-weighted
  const test::Consistency found = consistency_of_points(options, 0.02F);
  EXPECT_GT(found.mean_nees(), found.lower_bound());
  EXPECT_LT(found.mean_nees(), found.upper_bound());
}

TEST(RegistrationCovariance, IsAsLargeAsTheKernelMakesIt) {
  const RegistrationOptions options = options_of_independent_points();
  const double share = predicted_nees_share(options.kernel_width);
  EXPECT_LT(share, 1) << "it is too large rather than too small";
  const test::Consistency found = consistency_of_points(options, 0.02F);
  EXPECT_GT(found.mean_nees(), share * found.lower_bound());
  EXPECT_LT(found.mean_nees(), share * found.upper_bound());
}

/// Both clouds from plane fits of noisy ranges in a box, whose windows share pixels.
test::Consistency consistency_of_plane_fits(const RegistrationOptions& options, float sigma_m,
                                            const Vector3d& box_min = covariance_box_min,
                                            const Vector3d& box_max = covariance_box_max) {
  const CameraModel camera = test::small_camera();
  std::mt19937 random(3);
  std::normal_distribution<float> noise(0, sigma_m);
  const auto noisy_cloud = [&](const Pose& world_from_camera) {
    RangeImage image = test::box_ranges(camera, box_min, box_max, world_from_camera, sigma_m);
    for (float& range_m : image.range_m.reshaped()) range_m += noise(random);
    return surface_cloud(image, pixel_rays(camera), {});
  };
  test::Consistency consistency;
  for (int draw = 0; draw < draws; ++draw) {
    const SurfaceCloud target = noisy_cloud(Pose::Identity());
    const RegistrationResult result = register_clouds(noisy_cloud(truth), target, options);
    EXPECT_TRUE(succeeded(result.status));
    consistency.add(error_of(result), result.covariance);
  }
  return consistency;
}

TEST(RegistrationCovariance, IsNotTooSmallWherePlaneFitsShareTheirPixels) {
  RegistrationOptions options;
  options.systematic_sigma_m = 0;  // there is none
  const test::Consistency found = consistency_of_plane_fits(options, 0.01F);
  EXPECT_LT(found.mean_nees(), found.upper_bound());
  // Measured: 4.7, where 6 would be exact. The default of `correlated_observations` allows for more
  // shared pixels than the windows of this small image have, by less than a factor of two.
  EXPECT_GT(found.mean_nees(), 0.5 * found.lower_bound());
  options.correlated_observations = 1;
  // Measured: 57.
  EXPECT_GT(consistency_of_plane_fits(options, 0.01F).mean_nees(), 5 * found.upper_bound())
      << "without allowance for correlation the covariance is far too small";
}

TEST(RegistrationCovariance, IsNotTooSmallWhereMostInformationComesFromNoiseOfNormals) {
  RegistrationOptions options;
  options.systematic_sigma_m = 0;
  // A wide wall six metres ahead. The other walls are seen by a few pixels at the image's edges.
  const Vector3d box_min(-4, -2, -1);
  const Vector3d box_max(4, 2.8, 6);
  for (const float sigma_m : {0.03F, 0.06F}) {
    const test::Consistency found = consistency_of_plane_fits(options, sigma_m, box_min, box_max);
    EXPECT_LT(found.mean_nees(), found.upper_bound()) << sigma_m;
  }
}

}  // namespace
}  // namespace tofmap
