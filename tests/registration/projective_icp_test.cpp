// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "normal_equations.hpp"
#include "support/box_room.hpp"

#include <array>
#include <random>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

// A corner of this box is in view: walls in three directions hold the camera.
const Vector3d box_min(-1.5, -1.0, -1);
const Vector3d box_max(2.0, 1.2, 4);

MotionPrior loose_prior() { return {Pose::Identity(), 0.1, 0.2}; }

RegistrationResult register_in_box(const Pose& truth, const MotionPrior& prior,
                                   const Vector3d& min = box_min, const Vector3d& max = box_max) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud target = test::box_cloud(camera, min, max, Pose::Identity());
  const SurfaceCloud source = test::box_cloud(camera, min, max, truth);
  const std::array<RegistrationTarget, 1> targets{{{&target, Pose::Identity()}}};
  return register_to_targets(source, targets, camera, prior, {});
}

TEST(Registration, FindsAKnownMotionWhereThreeWallsAreInView) {
  const Pose truth = test::moved_by({0.02, -0.04, 0.03}, {0.05, -0.03, 0.06});
  const RegistrationResult result = register_in_box(truth, loose_prior());
  EXPECT_EQ(result.status, RegistrationStatus::converged);
  EXPECT_EQ(result.degenerate_directions, 0);
  // Exact planes: what is left is the prior's pull and the rounding of float clouds.
  EXPECT_LT((result.world_from_camera.translation() - truth.translation()).norm(), 5e-4);
  EXPECT_LT(rotation_angle_rad(result.world_from_camera, truth), 2e-4);
  EXPECT_GT(result.inlier_ratio, 0.9);
  EXPECT_FALSE(converged_slowly(result, {}));
}

TEST(Registration, IsSlowIfItTakesMostOfTheIterationsAllowed) {
  RegistrationOptions options;
  options.max_iterations = 10;
  RegistrationResult result;
  result.iterations = 6;
  EXPECT_FALSE(converged_slowly(result, options));
  result.iterations = 7;
  EXPECT_TRUE(converged_slowly(result, options));
}

TEST(Registration, LeavesDirectionsThatABareWallDoesNotHoldToThePrior) {
  // One wall fills the view: sideways motion and roll cannot be seen.
  const Vector3d min(-50, -50, -50);
  const Vector3d max(50, 50, 3);
  const Pose truth = test::moved_by({0, 0, 0}, {0.1, 0.05, 0.04});
  MotionPrior prior = loose_prior();
  prior.world_from_camera.translation() = Vector3d(0.02, 0.01, 0);
  const RegistrationResult result = register_in_box(truth, prior, min, max);
  EXPECT_EQ(result.degenerate_directions, 3);
  EXPECT_NEAR(result.world_from_camera.translation().z(), 0.04, 1e-3);
  EXPECT_NEAR(result.world_from_camera.translation().x(), 0.02, 1e-3);
  EXPECT_NEAR(result.world_from_camera.translation().y(), 0.01, 1e-3);
  // The covariance says so: sideways no better than the prior, towards the wall far better.
  EXPECT_NEAR(std::sqrt(result.covariance(3, 3)), 0.2, 0.02);
  EXPECT_LT(std::sqrt(result.covariance(5, 5)), 0.01);
}

TEST(Registration, BelievesPointsByTheirConfidence) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud target = test::box_cloud(camera, box_min, box_max, Pose::Identity());
  SurfaceCloud source = target;
  // The left half has moved ahead by what no robust kernel minds at this noise.
  const float ahead_m = 0.01F;
  for (SurfacePoint& point : source) {
    if (point.x > 0) continue;
    point.z += ahead_m;
    point.confidence = 0.01F;
  }
  const std::array<RegistrationTarget, 1> targets{{{&target, Pose::Identity()}}};
  const RegistrationResult result = register_to_targets(source, targets, camera, loose_prior(), {});
  EXPECT_LT(result.world_from_camera.translation().norm(), 0.05 * ahead_m);
  for (SurfacePoint& point : source) point.confidence = 1;
  const RegistrationResult trusting =
      register_to_targets(source, targets, camera, loose_prior(), {});
  EXPECT_GT(trusting.world_from_camera.translation().norm(), 0.2 * ahead_m);
}

/// One wall, 3 m away, with noise of the predicted size.
SurfaceCloud noisy_wall(const CameraModel& camera, const Pose& world_from_camera, unsigned seed) {
  constexpr float sigma_m = 0.01F;
  RangeImage image = test::box_ranges(camera, Vector3d(-50, -50, -50), Vector3d(50, 50, 3),
                                      world_from_camera, sigma_m);
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma_m);
  for (float& range : image.range_m.reshaped()) range += noise(random);
  return surface_cloud(image, pixel_rays(camera), {});
}

TEST(Registration, IsNotMovedByTheNoiseOfABareWallsNormals) {
  const CameraModel camera = test::small_camera();
  const Pose truth = test::moved_by({0, 0, 0}, {0.1, 0.05, 0.04});
  for (unsigned seed = 0; seed < 10; ++seed) {
    const SurfaceCloud target = noisy_wall(camera, Pose::Identity(), 2 * seed);
    const SurfaceCloud source = noisy_wall(camera, truth, 2 * seed + 1);
    const std::array<RegistrationTarget, 1> targets{{{&target, Pose::Identity()}}};
    // As narrow as that of a camera that goes on steadily.
    MotionPrior prior{Pose::Identity(), 0.03, 0.03};
    prior.world_from_camera.translation() = Vector3d(0.1, 0.05, 0);
    const RegistrationResult result = register_to_targets(source, targets, camera, prior, {});
    EXPECT_EQ(result.degenerate_directions, 3) << seed;
    // Sideways lies within the tilt of a wall that noise tilts by milliradians.
    EXPECT_NEAR(result.world_from_camera.translation().x(), 0.1, 0.002) << seed;
    EXPECT_NEAR(result.world_from_camera.translation().y(), 0.05, 0.002) << seed;
    EXPECT_NEAR(result.world_from_camera.translation().z(), 0.04, 0.002) << seed;
    const Eigen::SelfAdjointEigenSolver<Matrix6d> told(result.target_information.front());
    EXPECT_LT(told.eigenvalues()[2], 1e-6 * told.eigenvalues()[3]) << seed;
  }
}

TEST(Registration, TellsWhichTargetConstrainsTheCamera) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud corner = test::box_cloud(camera, box_min, box_max, Pose::Identity());
  // The same far wall without the side walls, floor and ceiling.
  const SurfaceCloud wall =
      test::box_cloud(camera, {-50, -50, -50}, {50, 50, box_max.z()}, Pose::Identity());
  const std::array<RegistrationTarget, 2> targets{
      {{&wall, Pose::Identity()}, {&corner, Pose::Identity()}}};
  const Pose truth = test::moved_by({0, 0, 0}, {0.05, -0.03, 0.02});
  const SurfaceCloud source = test::box_cloud(camera, box_min, box_max, truth);
  const RegistrationResult result = register_to_targets(source, targets, camera, loose_prior(), {});
  ASSERT_EQ(result.degenerate_directions, 0);
  ASSERT_EQ(result.target_information.size(), 2U);
  const Matrix6d& of_wall = result.target_information[0];
  const Matrix6d& of_corner = result.target_information[1];
  for (const int sideways : {3, 4}) {
    EXPECT_LT(of_wall(sideways, sideways), 1e-3 * of_corner(sideways, sideways)) << sideways;
  }
  EXPECT_GT(of_wall(5, 5), 0.1 * of_corner(5, 5)) << "towards the wall";
}

TEST(Registration, IsPreviewedForATarget) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud corner = test::box_cloud(camera, box_min, box_max, Pose::Identity());
  const std::array<RegistrationTarget, 1> targets{{{&corner, Pose::Identity()}}};
  const Pose truth = test::moved_by({0, 0, 0}, {0.05, -0.03, 0.02});
  const SurfaceCloud source = test::box_cloud(camera, box_min, box_max, truth);
  MotionPrior prior = loose_prior();
  prior.world_from_camera = truth;
  const RegistrationResult result = register_to_targets(source, targets, camera, prior, {});
  const TargetPreview preview = preview_target(source, truth, targets[0], camera, {});
  EXPECT_EQ(preview.overlap, overlap_share(source, truth, targets[0], camera, {}));
  // A hundred points stand for some thousand. One in five lies at the border of the image, beyond
  // which the target saw nothing.
  EXPECT_NEAR(preview.overlap, result.overlap, 0.2);
  for (int i = 0; i < 6; ++i) {
    const double all = result.target_information[0](i, i);
    EXPECT_GT(preview.information(i, i), 0.6 * all) << i;
    EXPECT_LT(preview.information(i, i), 1.6 * all) << i;
  }
  const SurfaceCloud nothing;
  EXPECT_EQ(preview_target(nothing, truth, targets[0], camera, {}).overlap, 0);
}

TEST(Registration, FailsWithoutOverlap) {
  const CameraModel camera = test::small_camera();
  const SurfaceCloud source = test::box_cloud(camera, box_min, box_max, Pose::Identity());
  const Pose far_away = test::moved_by({0, 3, 0}, {50, 0, 0});
  const std::array<RegistrationTarget, 1> targets{{{&source, far_away}}};
  const RegistrationResult result = register_to_targets(source, targets, camera, loose_prior(), {});
  EXPECT_FALSE(succeeded(result.status));
}

TEST(Registration, RefusesAPriorWithoutWidth) {
  const CameraModel camera = test::small_camera();
  EXPECT_THROW(register_to_targets({}, {}, camera, {}, {}), UsageError);
}

TEST(ResidualJacobian, IsTheNumericDerivative) {
  const Vector3d point_m(0.7, -0.4, 2.1);
  const Vector3d normal = Vector3d(0.3, 0.5, -0.8).normalized();
  const Vector6d jacobian = residual_jacobian(point_m, normal);
  constexpr double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Vector6d twist = Vector6d::Zero();
    twist[i] = step;
    const double forward = normal.dot(pose_from_twist(twist) * point_m);
    twist[i] = -step;
    const double backward = normal.dot(pose_from_twist(twist) * point_m);
    EXPECT_NEAR(jacobian[i], (forward - backward) / (2 * step), 1e-8) << "component " << i;
  }
}

TEST(GemanMcClure, IsOneAtZeroAndAQuarterAtItsWidth) {
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(0, 3), 1);
  EXPECT_DOUBLE_EQ(geman_mcclure_weight(3, 3), 0.25);
  EXPECT_LT(geman_mcclure_weight(30, 3), 1e-3);
}

}  // namespace
}  // namespace tofmap
