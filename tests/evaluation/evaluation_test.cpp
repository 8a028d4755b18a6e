// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/evaluation/map_score.hpp>
#include <tofmap/evaluation/range_score.hpp>
#include <tofmap/evaluation/trajectory_score.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

TEST(RangeScore, IsTheWorkedExample) {
  RangeImage image(1, 5);
  image.range_m << 2.0F, 3.1F, 1.0F, NAN, 5.0F;
  image.reason << 0, 0, 0, static_cast<int>(InvalidReason::jump_edge), 0;
  ImageF truth(1, 5);
  truth << 2.0F, 3.0F, 6.0F, 4.0F, NAN;
  const RangeScore score = score_ranges(image, truth, 5.0);
  EXPECT_NEAR(score.wrong_wrap_percent, 100.0 / 3, 1e-9);  // 5 m off, of three with a range
  EXPECT_DOUBLE_EQ(score.coverage_percent, 75);            // three of four with truth
  EXPECT_NEAR(score.range_rmse_m, std::sqrt(0.01 / 2), 1e-6);
}

TEST(RangeScore, OfAFrameWithoutRangesDoesNotCountAmongOthers) {
  RangeImage none(1, 2);
  none.range_m << NAN, NAN;
  none.reason.setConstant(static_cast<int>(InvalidReason::jump_edge));
  RangeImage wrong = none;
  wrong.range_m << 1.0F, 4.0F;
  wrong.reason.setZero();
  ImageF truth(1, 2);
  truth << 6.0F, 4.0F;
  const RangeScore empty = score_ranges(none, truth, 5.0);
  EXPECT_TRUE(std::isnan(empty.wrong_wrap_percent));
  EXPECT_EQ(empty.coverage_percent, 0);
  const RangeScore mean = mean_score({empty, score_ranges(wrong, truth, 5.0)});
  EXPECT_EQ(mean.wrong_wrap_percent, 50);
  EXPECT_EQ(mean.coverage_percent, 50);
  EXPECT_TRUE(std::isnan(mean_score({}).wrong_wrap_percent));
}

TEST(RangeScore, DoesNotKnowTruthThatIsNoRange) {
  RangeImage image(1, 3);
  image.range_m << 2.0F, 2.0F, 2.0F;
  image.reason.setZero();
  ImageF truth(1, 3);
  truth << 2.0F, -1.0F, INFINITY;
  EXPECT_EQ(score_ranges(image, truth, 5.0).wrong_wrap_percent, 0);
  ErrorsOverRange errors;
  errors.add(image, truth, 5.0);
  ASSERT_EQ(errors.bins().size(), 1U);
  EXPECT_EQ(errors.bins().front().pixels, 1);
}

/// Five metres straight on, a pose every half metre.
Trajectory straight_path() {
  Trajectory path;
  for (int i = 0; i <= 10; ++i) {
    StampedPose pose;
    pose.timestamp_s = i;
    pose.world_from_camera.translation() = Vector3d(0.5 * i, 0.1 * (i % 2), 0);
    path.push_back(pose);
  }
  return path;
}

TEST(TrajectoryScore, IsZeroForTheSamePathInAnotherFrame) {
  Trajectory moved = straight_path();
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.3, -0.2, 1.0, 4, 5, 6;
  for (StampedPose& pose : moved) {
    pose.world_from_camera = pose_from_twist(twist) * pose.world_from_camera;
  }
  const auto score = score_trajectory(moved, straight_path());
  ASSERT_TRUE(score);
  EXPECT_EQ(score->matched, 11);
  EXPECT_NEAR(score->ate_rmse_m, 0, 1e-9);
  EXPECT_NEAR(score->rpe_rmse_m_per_m, 0, 1e-9);
}

TEST(TrajectoryScore, MeasuresAPathThatIsTenPercentTooLong) {
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i <= 10; ++i) {
    StampedPose pose;
    pose.timestamp_s = i;
    pose.world_from_camera.translation() = Vector3d(0.5 * i, 0, 0);
    truth.push_back(pose);
    pose.world_from_camera.translation() *= 1.1;
    estimate.push_back(pose);
  }
  const auto score = score_trajectory(estimate, truth);
  ASSERT_TRUE(score);
  EXPECT_NEAR(score->rpe_rmse_m_per_m, 0.1, 1e-9);
  // Aligned at the middle, errors are 0.05 m times −5 … 5: RMS 0.05 √10.
  EXPECT_NEAR(score->ate_rmse_m, 0.05 * std::sqrt(10.0), 1e-9);
  EXPECT_NEAR(score->ate_max_m, 0.25, 1e-9);
}

TEST(TrajectoryScore, OfAStraightPathFindsTheRotationAboutItByOrientations) {
  // Positions whose errors of 4 mm would tilt the map by a right angle.
  Trajectory truth;
  Trajectory estimate;
  for (int i = 0; i < 12; ++i) {
    StampedPose pose;
    pose.timestamp_s = i;
    pose.world_from_camera.translation() = Vector3d(0.03 * i, 0.004 * (i % 2), 0);
    truth.push_back(pose);
    pose.world_from_camera.translation() = Vector3d(0.03 * i, 0, 0.004 * (i % 2));
    estimate.push_back(pose);
  }
  const auto score = score_trajectory(estimate, truth);
  ASSERT_TRUE(score);
  const double angle_rad = Eigen::AngleAxisd(score->truth_from_estimate.rotation()).angle();
  EXPECT_LT(angle_rad, 0.01);
  EXPECT_LT(score->ate_rmse_m, 0.004);
}

TEST(TrajectoryScore, NeedsThreePosesOfTheSameTime) {
  Trajectory late = straight_path();
  for (StampedPose& pose : late) pose.timestamp_s += 0.5;
  EXPECT_FALSE(score_trajectory(late, straight_path()));
}

MapCloud plane_map(double z, double step_m) {
  MapCloud map;
  for (double x = -0.5; x < 0.5; x += step_m) {
    for (double y = -0.5; y < 0.5; y += step_m) {
      MapPoint point;
      point.getVector3fMap() = Vector3d(x, y, z).cast<float>();
      map.push_back(point);
    }
  }
  return map;
}

/// The rays of a camera with a square image.
PixelRays square_rays(int size_px, double focal_px) {
  CameraModel camera;
  camera.width_px = camera.height_px = size_px;
  camera.fx_px = camera.fy_px = focal_px;
  camera.cx_px = camera.cy_px = (size_px - 1) / 2.0;
  return pixel_rays(camera);
}

/// Seen from `at`.
ReferenceSurface plane_reference(const Vector3d& at = Vector3d::Zero()) {
  const PixelRays rays = square_rays(200, 200);
  const Pose pose(Eigen::Translation3d{at});
  ReferenceSurface reference(origin_near({{0, pose}}));
  reference.add(ImageF(1.0F / rays.z), rays, pose);
  return reference;
}

TEST(MapScore, MeasuresAMapThatIsTwoCentimetresOff) {
  const MapScore score = score_map(plane_map(1.02, 0.03), Pose::Identity(), plane_reference());
  EXPECT_NEAR(score.accuracy_m, 0.02, 1e-4);
  EXPECT_DOUBLE_EQ(score.far_percent, 0);
  EXPECT_DOUBLE_EQ(score.completeness_percent, 100);
}

// A floor 1.5 m below the camera: from 10 m on, its samples are more than 0.3 m apart.
TEST(MapScore, DoesNotCountTheSpacingOfTheTruthAsError) {
  constexpr float height_m = 1.5F;
  const PixelRays rays = square_rays(100, 80);
  ReferenceSurface reference;
  reference.add((rays.y > 0.12F).select(height_m / rays.y, ImageF::Constant(100, 100, NAN)), rays,
                Pose::Identity());
  MapCloud map;
  for (int i = 0; i < 200; ++i) {
    MapPoint point;
    point.getVector3fMap() = Eigen::Vector3f(0.01F * static_cast<float>(i % 20), height_m - 0.03F,
                                             3 + 0.04F * static_cast<float>(i));
    map.push_back(point);
  }
  const MapScore score = score_map(map, Pose::Identity(), reference);
  EXPECT_NEAR(score.accuracy_m, 0.03, 1e-3);
  EXPECT_GT(*std::ranges::max_element(reference.spacings_m()), 0.3F);
  const std::vector<float> limited = map_errors_m(map, Pose::Identity(), reference, 0.1);
  EXPECT_EQ(limited, score.errors_m);
}

// A pole of one sample's width, 1.5 m before a wall: what is beside it is not on its surface.
TEST(MapScore, DoesNotTakeOtherSurfacesForTheSpacingOfTheTruth) {
  const PixelRays rays = square_rays(40, 200);
  ImageF range_m = 3 / rays.z;
  range_m.middleCols(20, 2) = 1.5F / rays.z.middleCols(20, 2);
  ReferenceSurface reference;
  reference.add(range_m, rays, Pose::Identity());
  EXPECT_LT(*std::ranges::max_element(reference.spacings_m()), 0.05F);
}

TEST(MapScore, IsTheSameInANationalGrid) {
  const Vector3d at(5e6, -5e6, 300);
  const MapCloud map = plane_map(1.02, 0.03);
  const MapScore here = score_map(map, Pose::Identity(), plane_reference());
  const MapScore there = score_map(map, Pose(Eigen::Translation3d(at)), plane_reference(at));
  // Doubles step by 1e-9 m there, floats near the origin by 1e-7 m.
  EXPECT_NEAR(there.accuracy_m, here.accuracy_m, 1e-6);
  EXPECT_DOUBLE_EQ(there.completeness_percent, here.completeness_percent);
}

TEST(OriginNear, IsTheMedianInWholeMetres) {
  const auto at = [](double x, double y, double z) {
    return StampedPose{0, Pose(Eigen::Translation3d(x, y, z))};
  };
  EXPECT_EQ(origin_near({}), Vector3d::Zero());
  EXPECT_EQ(origin_near({at(5e6 + 0.2, 2.6, -1), at(0, 0, 0), at(5e6 + 0.3, 2.7, -1)}),
            Vector3d(5e6, 3, -1))
      << "one pose at zero does not count";
}

TEST(MapScore, CountsWhatIsMissingAndWhatIsFar) {
  MapCloud map = plane_map(1, 0.03);
  std::erase_if(map.points, [](const MapPoint& point) { return point.x > 0; });
  MapPoint astray;
  astray.getVector3fMap() = Eigen::Vector3f(0, 0, 3);
  map.points.push_back(astray);
  const MapScore score = score_map(map, Pose::Identity(), plane_reference());
  EXPECT_NEAR(score.far_percent, 100.0 / static_cast<double>(map.points.size()), 1e-6);
  // Half the plane, and the 0.1 m beyond its middle that still count.
  EXPECT_NEAR(score.completeness_percent, 60, 4);
}

TEST(MapScore, RefusesAnEmptyReference) {
  EXPECT_THROW(score_map(plane_map(1, 0.1), Pose::Identity(), {}), UsageError);
}

TEST(MapErrors, AreThoseOfTheScorePointByPoint) {
  constexpr float most_error_m = 0.5;
  MapCloud map = plane_map(1.02, 0.03);
  MapPoint astray;
  astray.getVector3fMap() = Eigen::Vector3f(0, 0, 3);
  map.points.push_back(astray);
  const std::vector<float> errors = map_errors_m(map, Pose::Identity(), plane_reference());
  ASSERT_EQ(errors.size(), map.points.size());
  EXPECT_NEAR(errors.front(), 0.02, 1e-4);
  EXPECT_NEAR(errors.back(), 2, 1e-4);
  std::vector<float> limited = map_errors_m(map, Pose::Identity(), plane_reference(), most_error_m);
  EXPECT_FLOAT_EQ(limited.back(), most_error_m);
  limited.back() = errors.back();
  EXPECT_EQ(limited, errors) << "the others are near";
  EXPECT_EQ(score_map(map, Pose::Identity(), plane_reference()).errors_m, errors);
  EXPECT_THROW(map_errors_m(map, Pose::Identity(), {}), UsageError);
}

TEST(ErrorsOverRange, AreBinnedByTheTruth) {
  RangeImage image(1, 4);
  image.range_m << 2.1F, 2.1F, 7.1F, 9.0F;
  image.reason << 0, 0, 0, 0;
  ImageF truth(1, 4);
  truth << 2.2F, 7.2F, 7.4F, NAN;  // right, a wrap too near, right, not known
  ErrorsOverRange errors;
  errors.add(image, truth, 5);
  ErrorsOverRange both;
  both.add(errors);
  both.add(errors);
  const std::vector<ErrorsOverRange::Bin> bins = both.bins();
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_DOUBLE_EQ(bins[0].range_m, 2.25);
  EXPECT_EQ(bins[0].pixels, 2);
  EXPECT_EQ(bins[0].wrong_wrap_percent, 0);
  EXPECT_NEAR(bins[0].range_rmse_m, 0.1, 1e-6);
  EXPECT_DOUBLE_EQ(bins[1].range_m, 7.25);
  EXPECT_EQ(bins[1].pixels, 4);
  EXPECT_EQ(bins[1].wrong_wrap_percent, 50);
  EXPECT_NEAR(bins[1].range_rmse_m, 0.3, 1e-6);
}

TEST(PoseErrors, AreThoseOfTheScore) {
  Trajectory estimate = straight_path();
  estimate[4].world_from_camera.translation().z() += 0.2;
  estimate[7].timestamp_s += 0.3;  // no true pose is that near
  const auto score = score_trajectory(estimate, straight_path());
  ASSERT_TRUE(score);
  const auto errors = pose_errors(estimate, straight_path(), score->truth_from_estimate);
  ASSERT_EQ(errors.size(), 10U);
  EXPECT_EQ(errors[4].timestamp_s, 4);
  EXPECT_DOUBLE_EQ(errors[4].error_m, score->ate_max_m);
}

}  // namespace
}  // namespace tofmap
