// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <random>

#include <gtest/gtest.h>

#include <tofmap/cloud/downsample.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

TEST(Downsample, TakesTheMeanOfEachVoxelInTheOrderTheyAreMet) {
  const Points points{{5.1, 0, 0}, {0.1, 0.1, 0.1}, {5.3, 0.5, 0}, {-0.1, 0, 0}};
  const Points means = downsample(points, 1);
  ASSERT_EQ(means.size(), 3U);
  EXPECT_TRUE(means[0].isApprox(Eigen::Vector3d(5.2, 0.25, 0)));
  EXPECT_TRUE(means[1].isApprox(Eigen::Vector3d(0.1, 0.1, 0.1)));
  EXPECT_TRUE(means[2].isApprox(Eigen::Vector3d(-0.1, 0, 0)));
}

TEST(Downsample, KeepsPlacesApartAtSmallVoxelsOverLargeExtents) {
  // 10⁷ voxels along each axis: 10²¹ in all, while 32 bits count 4·10⁹.
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_m(-5000, 5000);
  Points points;
  for (int i = 0; i < 20000; ++i) {
    points.emplace_back(place_m(random), place_m(random), place_m(random));
    points.push_back(points.back());
  }
  const Points means = downsample(points, 0.001);
  ASSERT_EQ(means.size(), points.size() / 2);
  for (std::size_t i = 0; i < means.size(); ++i) EXPECT_EQ(means[i], points[2 * i]);
}

TEST(Downsample, LosesNoDigitsFarFromTheOrigin) {
  const Eigen::Vector3d far_m(4.5e6, 5.2e6, 100);
  const Points means = downsample(Points{far_m, far_m + Eigen::Vector3d(0.25, 0, 0)}, 1);
  ASSERT_EQ(means.size(), 1U);
  EXPECT_EQ(means[0], far_m + Eigen::Vector3d(0.125, 0, 0));
}

TEST(Downsample, RefusesVoxelsThatNumbersCannotCount) {
  const Points points{{1e9, 0, 0}};
  EXPECT_THROW(downsample(points, 0), UsageError);
  EXPECT_THROW(downsample(points, -1), UsageError);
  EXPECT_THROW(downsample(points, 1e-8), UsageError);
}

TEST(VoxelForCount, LeavesAboutSoMany) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place_m(0, 10);
  Points points;
  for (int i = 0; i < 100000; ++i) points.emplace_back(place_m(random), place_m(random), 0);
  for (const std::size_t wanted : {500U, 5000U}) {
    const auto left =
        static_cast<double>(downsample(points, voxel_for_count(points, wanted)).size());
    // A tenth in size is a fifth in number on a plane.
    EXPECT_NEAR(left, static_cast<double>(wanted), 0.25 * static_cast<double>(wanted));
  }
}

TEST(VoxelForCount, HasAnAnswerForOnePoint) {
  EXPECT_GT(voxel_for_count(Points{{1, 2, 3}}, 10), 0);
  EXPECT_GT(voxel_for_count(Points{}, 10), 0);
}

TEST(RemoveStrays, TakesOutWhatIsFarOffAllOthers) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 1000; ++i) points.emplace_back(0.01 * i + 500, 3, -2);  // ten metres
  points.emplace_back(1e7, 0, 0);
  points.emplace_back(500, 1e300, 0);
  points.emplace_back(560, 3, -2);  // a far wall seen through a door
  EXPECT_EQ(remove_strays(points), 2U);
  EXPECT_EQ(points.size(), 1001U);
  EXPECT_EQ(remove_strays(points), 0U);
}

TEST(RemoveStrays, LeavesWhatHasNoExtent) {
  std::vector<Eigen::Vector3d> none;
  EXPECT_EQ(remove_strays(none), 0U);
  std::vector<Eigen::Vector3d> alike(10, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(remove_strays(alike), 0U);
}

}  // namespace
}  // namespace tofmap
