// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cloud_equations.hpp"

#include <gtest/gtest.h>
#include <support/scans.hpp>

#include <tofmap/cloud/downsample.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/registration/cloud_icp.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

constexpr double voxel_m = 0.1;

OrientedCloud oriented(const PointSet& points) {
  return orient(downsample(points.points, voxel_m), voxel_m, Eigen::Vector3d::Zero()).value();
}

/// Two scans of a furnished room from half a metre apart.
class TwoScans : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const RayScene scene(make_scene("room").surface);
    const Pose first = make_scene("room").path.pose_at(0);
    target_from_source_ = test::moved_by({0.02, -0.1, 0.05}, {0.3, 0.1, -0.3});
    target_ = std::make_unique<OrientedCloud>(oriented(test::scan(scene, first, 1)));
    source_ = std::make_unique<OrientedCloud>(
        oriented(test::scan(scene, first * target_from_source_, 2)));
  }
  static void TearDownTestSuite() {
    target_.reset();
    source_.reset();
  }

  static inline Pose target_from_source_;
  static inline std::unique_ptr<OrientedCloud> target_;
  static inline std::unique_ptr<OrientedCloud> source_;
};

double error_m(const Pose& a, const Pose& b) {
  constexpr double lever_m = 3;
  return (a.translation() - b.translation()).norm() + lever_m * rotation_angle_rad(a, b);
}

TEST_F(TwoScans, AreAlignedByEveryMethodFromNearBy) {
  const Pose start = target_from_source_ * test::moved_by({0, 0.03, 0}, {0.05, 0, -0.04});
  for (const CloudMethod method :
       {CloudMethod::generalised, CloudMethod::point_to_plane, CloudMethod::pcl_gicp}) {
    const auto result = align_clouds(*source_, *target_, start, {method, 2.5 * voxel_m});
    EXPECT_TRUE(result.converged);
    // A fifth of a voxel: clouds are means over voxels that lie elsewhere in each.
    EXPECT_LT(error_m(result.target_from_source, target_from_source_), 0.2 * voxel_m)
        << static_cast<int>(method);
  }
  // Point to point holds on to the voxels themselves.
  const auto result =
      align_clouds(*source_, *target_, start, {CloudMethod::pcl_icp, 2.5 * voxel_m});
  EXPECT_LT(error_m(result.target_from_source, target_from_source_),
            error_m(start, target_from_source_));
}

TEST_F(TwoScans, FitWhereTheyBelongAndNotElsewhere) {
  const CloudFit right = measure_fit(*source_, *target_, target_from_source_);
  EXPECT_GT(right.overlap, 0.7);
  EXPECT_GT(right.inlier_ratio, 0.8);
  EXPECT_LT(right.rmse_m, 0.02);
  const Pose wrong = test::moved_by({0, 0.4, 0}, {0.5, 0, 0}) * target_from_source_;
  EXPECT_LT(measure_fit(*source_, *target_, wrong).inlier_ratio, right.inlier_ratio - 0.15);
  const Pose far = test::moved_by({0, 0, 0}, {100, 0, 0});
  EXPECT_EQ(measure_fit(*source_, *target_, far).overlap, 0);
}

TEST_F(TwoScans, ThatAreTheSameStayWhereTheyAre) {
  const auto result =
      align_clouds(*target_, *target_, Pose::Identity(), {CloudMethod::generalised, 2.5 * voxel_m});
  EXPECT_TRUE(result.converged);
  EXPECT_LT(error_m(result.target_from_source, Pose::Identity()), 1e-6);
}

TEST(CloudIcp, SaysWhichDirectionsAWallLeavesFree) {
  PointSet wall;
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < 80; ++j) wall.points.emplace_back(0.05 * i, 0.05 * j, 3);
  }
  const OrientedCloud cloud = oriented(wall);
  const auto result =
      align_clouds(cloud, cloud, Pose::Identity(), {CloudMethod::point_to_plane, 2.5 * voxel_m});
  // Two ways to slide and one to turn.
  EXPECT_LT(result.direction_shares[2], 1e-6);
  EXPECT_GT(result.direction_shares[3], 0.05);
}

TEST(Orient, RefusesTooFewPoints) {
  const PointSet points{{{1, 2, 3}, {2, 3, 4}}, {}};
  EXPECT_FALSE(orient(points.points, voxel_m, Eigen::Vector3d::Zero()));
}

PointPair some_pair() {
  PointPair pair;
  pair.point_m = {1, -2, 0.5};
  pair.difference_m = {0.02, 0.01, -0.03};
  pair.information = plane_to_plane_information(Eigen::Vector3d(1, 2, 2) / 3,
                                                Eigen::Vector3d(2, 1, 2) / 3, 0.01, 0.1);
  return pair;
}

TEST(GapJacobian, IsThatOfNumericDifferences) {
  const PointPair pair = some_pair();
  const auto jacobian = difference_jacobian(pair);
  constexpr double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Vector6d twist = Vector6d::Zero();
    twist[i] = step;
    const Eigen::Vector3d moved = pose_from_twist(twist) * pair.point_m;
    twist[i] = -step;
    const Eigen::Vector3d back = pose_from_twist(twist) * pair.point_m;
    EXPECT_LT(((moved - back) / (2 * step) - jacobian.col(i)).norm(), 1e-8);
  }
}

TEST(PlaneToPlaneInformation, IsThatOfBothPlanesScatter) {
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d information = plane_to_plane_information(normal, normal, 0.01, 0.1);
  EXPECT_NEAR(information(2, 2), 1 / (2 * 0.01 * 0.01), 1e-6);
  EXPECT_NEAR(information(0, 0), 1 / (2 * 0.1 * 0.1), 1e-6);
  EXPECT_NEAR(information(0, 2), 0, 1e-9);
}

TEST(CloudEquations, HaveTheGradientOfTheRobustCost) {
  const PointPair pair = some_pair();
  constexpr double width = 2;
  // Geman and McClure's ρ(d) = ½ d² / (1 + d²/w²), whose weight ρ'(d)/d is 1 / (1 + d²/w²)².
  const auto cost = [&](const Vector6d& twist) {
    PointPair moved = pair;
    moved.difference_m += pose_from_twist(twist) * pair.point_m - pair.point_m;
    const double squared = moved.mahalanobis_distance() * moved.mahalanobis_distance();
    return 0.5 * squared / (1 + squared / (width * width));
  };
  const NormalEquations equations = build_equations(std::vector<PointPair>{pair}, width);
  constexpr double step = 1e-6;
  for (int i = 0; i < 6; ++i) {
    Vector6d twist = Vector6d::Zero();
    twist[i] = step;
    const double numeric = (cost(twist) - cost(-twist)) / (2 * step);
    EXPECT_NEAR(equations.gradient[i], numeric, 1e-4 * equations.gradient.norm());
  }
}

}  // namespace
}  // namespace tofmap
