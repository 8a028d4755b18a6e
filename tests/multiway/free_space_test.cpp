// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "free_space.hpp"

#include "wall.hpp"

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Points together(Points points, const Points& more) {
  points.insert(points.end(), more.begin(), more.end());
  return points;
}

/// The wall that the sensor at the origin sees.
Points far_wall() { return test::wall(4, 3, 2); }

/// What a cloud shows of the space that a sensor at the origin saw.
FreeSpaceEvidence evidence_of(const Points& seen, const Points& cloud) {
  Points dense;  // as on finer levels
  for (const Eigen::Vector3d& point : seen) {
    for (const double y_m : {-0.025, 0.025}) {
      for (const double z_m : {-0.025, 0.025}) {
        dense.emplace_back(point + Eigen::Vector3d(0, y_m, z_m));
      }
    }
  }
  LevelledCloud levels;
  levels.levels.push_back(test::oriented(cloud));
  levels.neighbours = VoxelNeighbours(levels.levels.front().points_m, test::wall_voxel_m);
  const SphericalView view(test::oriented(dense).points_m, Eigen::Vector3d::Zero());
  return free_space_evidence(view, levels, Pose::Identity());
}

TEST(FreeSpace, IsNotViolatedByTheSameSurface) {
  const FreeSpaceEvidence same = evidence_of(far_wall(), far_wall());
  EXPECT_GT(same.on_surface, 2000);
  EXPECT_EQ(same.in_free_space, 0);
  EXPECT_EQ(same.violation_share(), 0);
}

TEST(FreeSpace, IsViolatedByASurfaceBeforeWhatTheSensorSaw) {
  const Points cupboard = test::wall(2.5, 0.4, 0.4);
  const FreeSpaceEvidence evidence = evidence_of(far_wall(), together(far_wall(), cupboard));
  EXPECT_GT(evidence.in_free_space, static_cast<int>(cupboard.size()) * 3 / 4);
  EXPECT_GT(evidence.violation_share(), 0.02);
  EXPECT_EQ(evidence.in_windows, 0);
}

TEST(FreeSpace, IsNotViolatedBehindWhatTheSensorSaw) {
  EXPECT_EQ(evidence_of(far_wall(), together(far_wall(), test::wall(6, 1, 1))).in_free_space, 0);
}

TEST(FreeSpace, IsNotViolatedByScatteredPoints) {
  Points scattered = far_wall();
  for (int y = -2; y <= 2; ++y) {
    for (int z = -2; z <= 2; ++z) scattered.emplace_back(2.5, 0.4 * y, 0.4 * z);
  }
  EXPECT_EQ(evidence_of(far_wall(), scattered).in_free_space, 0);
}

TEST(FreeSpace, IsNotViolatedByAFewPoints) {
  const FreeSpaceEvidence few{.on_surface = 20, .in_free_space = 11};
  const FreeSpaceEvidence enough{.on_surface = 20, .in_free_space = 12};
  EXPECT_EQ(few.violation_share(), 0);
  EXPECT_EQ(enough.violation_share(), 12.0 / 32);
}

TEST(FreeSpace, IsViolatedOnlyIfEveryPossibleSensorSawIt) {
  const Points cupboard = test::wall(2.5, 0.4, 0.4);
  LevelledCloud levels;
  levels.levels.push_back(test::oriented(together(far_wall(), cupboard)));
  levels.neighbours = VoxelNeighbours(levels.levels.front().points_m, test::wall_voxel_m);
  const std::vector<Eigen::Vector3f> wall_m = test::oriented(far_wall()).points_m;
  const SphericalView before(wall_m, Eigen::Vector3d::Zero());
  const SphericalView behind(wall_m, Eigen::Vector3d(8, 0, 0));
  const auto share = [&](std::vector<SphericalView> views) {
    return least_evidence(views, levels, Pose::Identity()).violation_share();
  };
  EXPECT_GT(share({before}), 0);
  EXPECT_GT(share({before, before}), 0);
  EXPECT_EQ(share({before, behind}), 0);
  EXPECT_EQ(share({}), 0);
}

TEST(FreeSpace, MayBeSeenThroughAWindow) {
  // The cloud shows a blind where the sensor sees through a window of 1.2 m by 1.2 m.
  Points seen = test::wall(8, 3, 3);
  for (const Eigen::Vector3d& point : far_wall()) {
    if (point.tail<2>().cwiseAbs().maxCoeff() > 0.65) seen.push_back(point);
  }
  const FreeSpaceEvidence evidence = evidence_of(seen, far_wall());
  EXPECT_EQ(evidence.in_free_space, 0);
  EXPECT_GT(evidence.in_windows, 30);
  EXPECT_EQ(evidence.window_share(),
            static_cast<double>(evidence.in_windows) / (evidence.in_windows + evidence.on_surface));
}

TEST(FreeSpace, IsNotExcusedByWindowsThatAreMostOfWhatIsSeen) {
  Points seen = test::wall(8, 3, 3);
  Points little_wall;
  for (const Eigen::Vector3d& point : test::wall(4, 1.2, 1.2)) {
    little_wall.push_back(point);
    if (point.tail<2>().cwiseAbs().maxCoeff() > 0.85) seen.push_back(point);
  }
  const FreeSpaceEvidence evidence = evidence_of(seen, little_wall);
  EXPECT_EQ(evidence.in_windows, 0);
  EXPECT_GT(evidence.violation_share(), 0.1);
}

}  // namespace
}  // namespace tofmap
