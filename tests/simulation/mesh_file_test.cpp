// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {
namespace {

class MeshFile : public testing::Test {
 protected:
  std::filesystem::path write(const char* name, const std::string& text) const {
    std::ofstream(folder_.path() / name, std::ios::binary) << text;
    return folder_.path() / name;
  }

  void expect_refusal(const std::filesystem::path& file, const std::string& part) const {
    try {
      read_mesh(file);
      ADD_FAILURE() << "read; expected a complaint about " << part;
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }

  test::TemporaryFolder folder_;
};

TriangleMesh sample_mesh() {
  TriangleMesh mesh;
  add_box(mesh, {0, 0, 0}, {1.25, 2, 3}, 51 / 255.0);
  add_cylinder(mesh, {3, 0, 0.5}, 0.5, 1, 204 / 255.0);
  return mesh;
}

TEST_F(MeshFile, KeepsVerticesTrianglesAndReflectanceAsPly) {
  const TriangleMesh mesh = sample_mesh();
  write_mesh_ply(folder_.path() / "a.ply", mesh);
  const TriangleMesh read = read_mesh(folder_.path() / "a.ply");
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.triangles, mesh.triangles);
  ASSERT_EQ(read.reflectance.size(), mesh.reflectance.size());
  for (std::size_t i = 0; i < read.reflectance.size(); ++i) {
    EXPECT_NEAR(read.reflectance[i], mesh.reflectance[i], 1e-6);
  }
}

constexpr const char* ascii_ply =
    "ply\nformat ascii 1.0\ncomment a square and more\nelement vertex 4\nproperty double x\n"
    "property float y\nproperty float z\nproperty float confidence\nproperty uchar red\n"
    "property uchar green\nproperty uchar blue\nelement face 1\n"
    "property list uchar int vertex_index\nproperty uchar flags\nelement edge 1\n"
    "property int vertex1\nproperty int vertex2\nend_header\n"
    "0 0 0 0.9 255 255 255\n1 0 0 0.9 0 0 0\n1 1 0.5 0.9 51 102 153\n0 1 0.5 0.9 0 0 255\n"
    "4 0 1 2 3 7\n0 1\n";

TEST_F(MeshFile, ReadsAsciiPlyWithOtherPropertiesAndCutsPolygons) {
  const TriangleMesh mesh = read_mesh(write("a.ply", ascii_ply));
  ASSERT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(1, 1, 0.5F));
  EXPECT_NEAR(mesh.reflectance[0], 1, 1e-6);
  EXPECT_NEAR(mesh.reflectance[2], 0.4, 1e-6);  // the mean of the colours
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST_F(MeshFile, ReadsBigEndianPlyWithoutColours) {
  std::string text =
      "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty short y\n"
      "property short z\nelement face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
  const unsigned char data[] = {0,    0, 0, 0, 0, 0, 1, 2, 0, 0, 0, 0, 0xff,
                                0xff, 0, 3, 0, 0, 3, 0, 0, 0, 1, 0, 2};
  text.append(reinterpret_cast<const char*>(data), sizeof data);
  const TriangleMesh mesh = read_mesh(write("a.ply", text));
  ASSERT_EQ(mesh.triangles.size(), 1U);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(258, 0, 0));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(-1, 3, 0));
  EXPECT_EQ(mesh.reflectance[0], 0.5F);
}

TEST_F(MeshFile, ReadsObjWithTexturesNormalsAndCountsFromTheEnd) {
  const TriangleMesh mesh =
      read_mesh(write("a.OBJ",
                      "# comment\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\n"
                      "vt 0 0\nusemtl wall\nf 1/1/1 2//1 3/1\r\nf -4 -2 -1\n"));
  ASSERT_EQ(mesh.triangles.size(), 2U);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST_F(MeshFile, CutAnywhereIsRefused) {
  const auto whole = folder_.path() / "whole.ply";
  write_mesh_ply(whole, sample_mesh());
  const auto size = std::filesystem::file_size(whole);
  for (const std::uintmax_t kept : {std::uintmax_t{2}, std::uintmax_t{60}, std::uintmax_t{250},
                                    size / 4, size / 2, 3 * size / 4, size - 4, size - 1}) {
    const auto cut = folder_.path() / "cut.ply";
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, kept);
    EXPECT_THROW(read_mesh(cut), InputError) << kept << " of " << size << " bytes";
  }
}

TEST_F(MeshFile, ThatIsWrongIsRefusedWithTheReason) {
  expect_refusal(folder_.path() / "none.ply", "no such file");
  expect_refusal(write("a.stl", "solid\n"), "neither .ply nor .obj");
  expect_refusal(write("a.ply", "obj\n"), "not a PLY file");
  expect_refusal(write("b.ply",
                       "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                       "end_header\n1\n"),
                 "no triangles");
  expect_refusal(write("c.ply",
                       "ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\n"
                       "end_header\n1\n"),
                 "quad");
  expect_refusal(write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "vertex 8");
  expect_refusal(write("b.obj", "v 0 0 0\nv 1 zero 0\n"), "line 2");
  expect_refusal(write("c.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n"), "line 3");
  expect_refusal(write("d.obj", "v 0 0 0\nv 9000 0 0\nv 0 9000 0\nf 1 2 3\n"), "millimetres");
  expect_refusal(write("d.ply",
                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                       "element face 1\nproperty list int int vertex_indices\n"
                       "end_header\n1\nnan\n2\n3 0 1 2\n"),
                 "not finite numbers");
}

TEST_F(MeshFile, ThatDoesNotFitOnTheDiskIsAnInputError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  EXPECT_THROW(write_mesh_ply("/dev/full", sample_mesh()), InputError);
}

TEST(TriangleMesh, WallsHaveTheirOpenings) {
  TriangleMesh mesh;
  add_wall(mesh, {0, 0, 0}, {4, 0, 0}, 3, 0.2, {{1, 2, 0, 2}, {2.5, 3, 1, 2}}, 0.5);
  // Along y at the middle of the door, above it, in the window and below it: the area of the
  // faces tells what is open: front and back of 12 m² each, less 2 and 0.5 m².
  double area = 0;
  for (const auto& triangle : mesh.triangles) {
    const Eigen::Vector3f a = mesh.vertices[triangle[0]];
    const Eigen::Vector3f normal =
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
    area += std::abs(normal.y()) / 2;
  }
  EXPECT_NEAR(area, 2 * (12 - 2 - 0.5), 1e-4);
  EXPECT_TRUE(bounds(mesh).isApprox(
      Eigen::AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0.2F, 3)), 1e-6));
}

}  // namespace
}  // namespace tofmap
