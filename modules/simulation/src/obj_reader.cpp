// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_readers.hpp"

#include <sstream>
#include <vector>

namespace tofmap {
namespace {

[[noreturn]] void fail_at(const std::filesystem::path& file, int line_number,
                          const std::string& line) {
  fail_to_read(file,
               "line " + std::to_string(line_number) + " cannot be understood: '" + line + "'");
}

Eigen::Vector3f parse_vertex(std::istringstream& words) {
  Eigen::Vector3f point;
  words >> point.x() >> point.y() >> point.z();
  return point;
}

/// Vertex indices, from 0, of corners of the form 'v', 'v/t', 'v//n' or 'v/t/n'. In the file, v
/// counts from 1, or backwards from −1, the last vertex. Empty if a corner is not a number or is 0.
std::vector<long> parse_face(std::istringstream& words, std::size_t vertex_count) {
  std::vector<long> corners;
  for (std::string word; words >> word;) {
    std::istringstream number(word);
    long corner = 0;
    if (!(number >> corner) || corner == 0) return {};
    corners.push_back(corner > 0 ? corner - 1 : static_cast<long>(vertex_count) + corner);
  }
  return corners;
}

}  // namespace

// Reads vertices and faces. Materials, normals, lines and textures do not affect ranges.
TriangleMesh read_obj_mesh(const std::filesystem::path& file) {
  std::istringstream in(read_bytes(file));
  TriangleMesh mesh;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      mesh.vertices.push_back(parse_vertex(words));
      mesh.reflectance.push_back(static_cast<float>(unknown_reflectance));
      if (!words) fail_at(file, number, line);
    } else if (key == "f") {
      const std::vector<long> corners = parse_face(words, mesh.vertices.size());
      if (corners.size() < 3) fail_at(file, number, line);
      add_polygon(mesh, corners, file);
    }
  }
  return mesh;
}

}  // namespace tofmap
