// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <fstream>

#include <gtest/gtest.h>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/point_file.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

class PointFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_.path() / name) << text;
    return folder_.path() / name;
  }

  test::TemporaryFolder folder_;
};

constexpr const char* vtk_text =
    "# vtk DataFile Version 3.0\npoints\nASCII\nDATASET POLYDATA\n"
    "POINTS 2 double\n4500000.25 2 3\n-1 -2 -3\n";

TEST_F(PointFile, MayBeVtk) {
  const PointSet points = read_points(write("a.vtk", vtk_text));
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_EQ(points.points[0], Eigen::Vector3d(4500000.25, 2, 3));
  EXPECT_EQ(points.points[1], Eigen::Vector3d(-1, -2, -3));
}

TEST_F(PointFile, OfVtkCanBeLookedAtAsAMap) {
  const MapCloud map = read_map(write("a.vtk", vtk_text));
  ASSERT_EQ(map.size(), 2U);
  EXPECT_EQ(map[1].z, -3);
  EXPECT_EQ(map[1].observations, 1U);
}

TEST_F(PointFile, MayHoldDoublesAndOtherFields) {
  const PointSet points = read_points(
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float quality\nproperty double x\n"
            "property double y\nproperty double z\nend_header\n7 4500000.25 2 3\n8 -1 -2 -3\n"));
  ASSERT_EQ(points.points.size(), 2U);
  EXPECT_EQ(points.points[0], Eigen::Vector3d(4500000.25, 2, 3));
}

TEST_F(PointFile, OfAnyKindMayBeEmptyForeignOrCut) {
  for (const char* name : {"a.pcd", "a.ply", "a.vtk", "a.vtp"}) {
    for (const char* text : {"", "no cloud", "\x89PNG\r\n", "FIELDS x y z\n", "DATA ascii\n"}) {
      EXPECT_THROW(read_points(write(name, text)), InputError) << name << ": " << text;
    }
  }
}

TEST_F(PointFile, IsLookedAtWithoutPointsThatAreNowhere) {
  const MapCloud map =
      read_map(write("organised.pcd",
                     "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
                     "COUNT 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 4\n"
                     "DATA ascii\nnan nan nan\n1 0 0\n2 inf 0\n3 0 0\n"));
  ASSERT_EQ(map.size(), 2U);
  EXPECT_EQ(map[1].x, 3);
}

TEST_F(PointFile, LeavesOutWhatIsNoReturn) {
  const PointSet points =
      read_points(write("a.pcd",
                        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
                        "COUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 3\n"
                        "DATA ascii\nnan nan nan\n0 0 0\n1 0 0\n"));
  ASSERT_EQ(points.points.size(), 1U);
  EXPECT_EQ(points.viewpoint.value(), Eigen::Vector3d(1, 2, 3));
}

TEST_F(PointFile, ThatIsNoneIsNamed) {
  const std::vector<std::filesystem::path> files{
      folder_.path() / "missing.ply",
      write("a.xyz", "1 2 3\n"),
      write("b.ply", "no ply\n"),
      write("c.vtk", "no vtk\n"),
      write("d.vtp", "no xml\n"),
      write("e.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
            "property float z\nend_header\nnan nan nan\n")};
  for (const auto& file : files) {
    try {
      read_points(file);
      FAIL() << file << " was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file.filename()), std::string::npos);
    }
  }
}

TEST_F(PointFile, OfSeveralCloudsSaysWhichAPointIsOf) {
  const auto file = folder_.path() / "merged.ply";
  write_labelled_points(file, {{{1, 2, 3}}, {}, {{4, 5, 6}, {7, 8, 9}}});
  EXPECT_EQ(read_points(file).points.size(), 3U);
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(text.find("property uint label"), std::string::npos);
  EXPECT_EQ(text.substr(text.size() - 4), std::string("\2\0\0\0", 4));
}

}  // namespace
}  // namespace tofmap
