// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "mesh_parts.hpp"

#include <algorithm>

namespace tofmap {

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, const MeshPart& part) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < part.vertices; ++i) {
    box.extend(mesh.vertices[part.first_vertex + i].cast<double>());
  }
  return box;
}

TriangleMesh without_parts(const TriangleMesh& mesh, const std::vector<MeshPart>& parts) {
  std::vector<bool> is_removed(mesh.vertices.size(), false);
  for (const MeshPart& part : parts) {
    for (std::size_t i = 0; i < part.vertices; ++i) is_removed[part.first_vertex + i] = true;
  }
  TriangleMesh rest;
  std::vector<std::uint32_t> index(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (is_removed[i]) continue;
    index[i] = static_cast<std::uint32_t>(rest.vertices.size());
    rest.vertices.push_back(mesh.vertices[i]);
    rest.reflectance.push_back(mesh.reflectance[i]);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    if (!is_removed[a]) rest.triangles.push_back({index[a], index[b], index[c]});
  }
  return rest;
}

void remove_gone(Scene& scene) {
  std::vector<MeshPart> gone;
  for (const FurniturePiece& piece : scene.furniture) {
    if (piece.state == PieceState::gone) gone.push_back(piece.part);
  }
  scene.surface = without_parts(scene.surface, gone);
  for (FurniturePiece& piece : scene.furniture) {
    MeshPart shifted = piece.part;
    for (const MeshPart& part : gone) {
      if (part.first_vertex >= piece.part.first_vertex) continue;
      shifted.first_vertex -= part.vertices;
      shifted.first_triangle -= part.triangles;
    }
    piece.part = shifted;
    if (piece.state != PieceState::gone) continue;
    piece.part = {};
    piece.box = {};
  }
}

std::vector<Eigen::Vector3d> sample_points(const TriangleMesh& mesh, const MeshPart& part) {
  constexpr std::size_t most = 40;
  const std::size_t stride = std::max<std::size_t>(1, (part.triangles + most - 1) / most);
  std::vector<Eigen::Vector3d> points_m;
  for (std::size_t i = 0; i < part.triangles; i += stride) {
    const auto& [a, b, c] = mesh.triangles[part.first_triangle + i];
    const Eigen::Vector3f sum = mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c];
    points_m.push_back(sum.cast<double>() / 3);
  }
  return points_m;
}

}  // namespace tofmap
