// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>

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

/// The bytes of a number in big-endian order.
template <class Number>
std::string big_endian(Number number) {
  std::string bytes(sizeof(Number), 0);
  std::memcpy(bytes.data(), &number, sizeof(Number));
  std::ranges::reverse(bytes);
  return bytes;
}

const std::string vtk_start = "# vtk DataFile Version 3.0\npoints\n";

TEST_F(PointFile, MayBeBinaryVtkOfAnyTypeOfNumber) {
  const std::string start = vtk_start + "BINARY\nDATASET POLYDATA\nPOINTS 1 ";
  for (const std::string& text :
       {start + "float\n" + big_endian(-2.5F) + big_endian(3.0F) + big_endian(4.0F),
        start + "double\n" + big_endian(-2.5) + big_endian(3.0) + big_endian(4.0)}) {
    const PointSet points = read_points(write("a.vtk", text + "\nVERTICES 1 2\n"));
    ASSERT_EQ(points.points.size(), 1U);
    EXPECT_EQ(points.points[0], Eigen::Vector3d(-2.5, 3, 4));
  }
  using Short = std::int16_t;
  const std::string shorts = big_endian(Short{-2}) + big_endian(Short{300}) + big_endian(Short{4});
  EXPECT_EQ(read_points(write("a.vtk", start + "short\n" + shorts)).points.at(0),
            Eigen::Vector3d(-2, 300, 4));
}

TEST_F(PointFile, OfVtkThatIsDamagedIsRefused) {
  const std::string binary = vtk_start + "BINARY\nDATASET POLYDATA\n";
  const std::string number = big_endian(1.0F);
  for (const std::string& text :
       {binary + "POINTS -5 float\n", binary + "POINTS 2 float\n" + number + number + number,
        binary + "POINTS 9000000000000000000 float\n" + number, binary + "POINTS 1 yards\n123",
        binary + "POINTS 1\n", vtk_start + "ASCII\nDATASET POLYDATA\nPOINTS 2 float\n1 2 3 4 5\n",
        vtk_start + "ASCII\nDATASET POLYDATA\nPOINTS 1 float\n1 2 VERTICES 1 2\n"}) {
    EXPECT_THROW(read_points(write("a.vtk", text)), InputError) << text;
  }
}

TEST_F(PointFile, OfVtkNeedsNoSoundCells) {
  const PointSet points =
      read_points(write("a.vtk", vtk_text + std::string("VERTICES 1 2\n9 5\n")));
  EXPECT_EQ(points.points.size(), 2U);
}

TEST_F(PointFile, OfPcdWhoseHeaderContradictsItselfIsRefused) {
  const std::string lines = "VERSION 0.7\nFIELDS x y z\n";
  const std::string counts = "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  const std::string number = big_endian(0.0F);
  const std::string two = number + number + number + number + number + number;
  const std::string end = "WIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n";
  ASSERT_THROW(read_points(write("a.pcd", lines + counts + end + two)), InputError)
      << "points at the origin";
  const std::string ascii = "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3\n";
  EXPECT_EQ(read_points(write("a.pcd", lines + counts + ascii)).points.size(), 1U);
  for (const std::string& text :
       {lines + "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 -1\n" + end + two,
        lines + "SIZE 4 4\nTYPE F F F\nCOUNT 1 1 1\n" + end + two,
        lines + "SIZE 4 4 0\nTYPE F F F\nCOUNT 1 1 1\n" + end + two,
        lines + "SIZE 4 4 4\nTYPE F F\nCOUNT 1 1 1\n" + end + two,
        lines + "SIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1e9\n" + end + two,
        lines + counts + "WIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA binary\n" + two,
        lines + counts + "WIDTH -2\nHEIGHT 1\nPOINTS 2\nDATA binary\n" + two}) {
    EXPECT_THROW(read_points(write("a.pcd", text)), InputError) << text;
  }
}

TEST_F(PointFile, OfPlyWhosePointsHaveListsIsRefused) {
  const std::string start =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_EQ(
      read_points(write("a.ply", start + face + "end_header\n1 2 3\n3 0 0 0\n")).points.size(), 1U);
  EXPECT_THROW(
      read_points(write("a.ply", start + "property list int int q\nend_header\n1 2 3 1 1\n")),
      InputError);
}

TEST_F(PointFile, MayHaveAnExtensionInCapitals) {
  EXPECT_EQ(read_points(write("A.VTK", vtk_text)).points.size(), 2U);
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
