// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_readers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <sstream>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

/// Larger meshes are hardly in metres.
constexpr double max_extent_m = 1000;

void check(const TriangleMesh& mesh, const std::filesystem::path& file) {
  if (mesh.triangles.empty()) {
    fail_to_read(file, "contains no triangles; a point cloud cannot be simulated");
  }
  const bool finite =
      std::ranges::all_of(mesh.vertices, [](const Eigen::Vector3f& v) { return v.allFinite(); });
  if (!finite) fail_to_read(file, "has vertices that are not finite numbers");
  const double extent_m = bounds(mesh).sizes().maxCoeff();
  if (extent_m > max_extent_m) {
    fail_to_read(file, "spans " + std::to_string(std::lround(extent_m)) +
                           " m; scale it to metres (is it in millimetres?)");
  }
}

void append(std::string& bytes, const void* value, std::size_t size) {
  static_assert(std::endian::native == std::endian::little, "the header states this byte order");
  bytes.append(static_cast<const char*>(value), size);
}

}  // namespace

void fail_to_read(const std::filesystem::path& file, const std::string& what) {
  throw InputError(file.string() + ": " + what);
}

std::string read_bytes(const std::filesystem::path& file) {
  refuse_no_file(file);
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in) fail_to_read(file, "cannot be read");
  return std::move(bytes).str();
}

void add_polygon(TriangleMesh& mesh, std::span<const long> corners,
                 const std::filesystem::path& file) {
  const long count = static_cast<long>(mesh.vertices.size());
  for (const long corner : corners) {
    if (corner >= 0 && corner < count) continue;
    fail_to_read(file, "a face refers to vertex " + std::to_string(corner) +
                           " (counted from 0), but there are " + std::to_string(count));
  }
  const auto id = [&](std::size_t i) { return static_cast<std::uint32_t>(corners[i]); };
  for (std::size_t i = 2; i < corners.size(); ++i) {
    mesh.triangles.push_back({id(0), id(i - 1), id(i)});
  }
}

TriangleMesh read_mesh(const std::filesystem::path& file) {
  const std::string kind = lower_extension(file);
  if (kind != ".ply" && kind != ".obj") {
    fail_to_read(file, "is neither .ply nor .obj; convert it to one of them");
  }
  if (!std::filesystem::is_regular_file(file)) fail_to_read(file, "no such file");
  TriangleMesh mesh = kind == ".ply" ? read_ply_mesh(file) : read_obj_mesh(file);
  check(mesh, file);
  return mesh;
}

void write_mesh_ply(const std::filesystem::path& file, const TriangleMesh& mesh) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\n"
         << "comment metres, z up; gray = reflectance * 255\n"
         << "element vertex " << mesh.vertices.size() << "\nproperty float x\nproperty float y\n"
         << "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         << "element face " << mesh.triangles.size()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string bytes = header.str();
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    append(bytes, mesh.vertices[i].data(), 3 * sizeof(float));
    const double gray = std::round(std::clamp(mesh.reflectance[i], 0.0F, 1.0F) * 255.0);
    bytes.append(3, static_cast<char>(static_cast<unsigned char>(gray)));
  }
  for (const auto& triangle : mesh.triangles) {
    bytes.push_back(3);
    append(bytes, triangle.data(), 3 * sizeof(std::uint32_t));
  }
  std::ofstream out(file, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) {
    throw InputError(file.string() +
                     ": cannot be written; is the disk full, or is permission missing?");
  }
}

}  // namespace tofmap
