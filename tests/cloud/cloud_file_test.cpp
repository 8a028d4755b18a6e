// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

MapCloud two_points() {
  MapCloud map;
  for (int i = 0; i < 2; ++i) {
    MapPoint point;
    point.getVector3fMap() = Eigen::Vector3f(1, 2, static_cast<float>(i));
    point.getNormalVector3fMap() = Eigen::Vector3f(0, 0, -1);
    point.confidence = 0.5F;
    point.observations = 7 + static_cast<unsigned>(i);
    map.push_back(point);
  }
  return map;
}

TEST(MapFile, ComesBackAsItWasWritten) {
  const test::TemporaryFolder folder;
  write_map(folder.path() / "map.ply", two_points());
  const MapCloud map = read_map(folder.path() / "map.ply");
  ASSERT_EQ(map.size(), 2U);
  EXPECT_EQ(map[1].z, 1);
  EXPECT_EQ(map[1].normal_z, -1);
  EXPECT_EQ(map[1].confidence, 0.5F);
  EXPECT_EQ(map[1].observations, 8U);
}

TEST(MapFile, MayBePcd) {
  const test::TemporaryFolder folder;
  write_map(folder.path() / "map.pcd", two_points());
  const MapCloud map = read_map(folder.path() / "map.pcd");
  ASSERT_EQ(map.size(), 2U);
  EXPECT_EQ(map[1].normal_z, -1);
  EXPECT_EQ(map[1].observations, 8U);
  write_map(folder.path() / "empty.pcd", {});
  EXPECT_TRUE(read_map(folder.path() / "empty.pcd").empty());
}

TEST(MapFile, WithoutPointsIsAWholeFile) {
  const test::TemporaryFolder folder;
  write_map(folder.path() / "map.ply", {});
  EXPECT_TRUE(read_map(folder.path() / "map.ply").empty());
}

TEST(MapFile, ThatIsMissingOrNoCloudIsNamed) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "broken.ply";
  EXPECT_THROW(read_map(file), InputError);
  std::ofstream(file) << "no ply at all\n";
  try {
    read_map(file);
    FAIL() << "a text was read as a cloud";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("broken.ply"), std::string::npos);
  }
}

TEST(MapFile, CannotBeWrittenIntoAMissingFolder) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(write_map(folder.path() / "none" / "map.ply", two_points()), InputError);
}

}  // namespace
}  // namespace tofmap
