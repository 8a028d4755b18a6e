// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/surface_mesh.hpp"

#include <bit>
#include <fstream>

#include <tofmap/core/error.hpp>

namespace tofmap {

// PCL's and VTK's writers do not report a full disk, and VTK's writer writes no normals.
void write_mesh(const std::filesystem::path& file, const SurfaceMesh& mesh) {
  static_assert(std::endian::native == std::endian::little);
  std::ofstream out(file, std::ios::binary);
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.points_m.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\n"
         "property float ny\nproperty float nz\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar uint vertex_indices\nend_header\n";
  const auto write = [&](const auto* values, std::size_t count) {
    out.write(reinterpret_cast<const char*>(values),
              static_cast<std::streamsize>(count * sizeof *values));
  };
  for (std::size_t i = 0; i < mesh.points_m.size(); ++i) {
    write(mesh.points_m[i].data(), 3);
    write(mesh.normals[i].data(), 3);
  }
  for (const auto& triangle : mesh.triangles) {
    constexpr std::uint8_t corners = 3;
    write(&corners, 1);
    write(triangle.data(), triangle.size());
  }
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written; is the disk full?");
}

}  // namespace tofmap
