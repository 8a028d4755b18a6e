// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/triangle_mesh.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

using Eigen::Vector3d;

std::uint32_t add_vertex(TriangleMesh& mesh, const Vector3d& point, double reflectance) {
  mesh.vertices.push_back(point.cast<float>());
  mesh.reflectance.push_back(static_cast<float>(reflectance));
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Adds the parallelepiped with the corner c and the edges a, b, h.
void add_block(TriangleMesh& mesh, const Vector3d& c, const Vector3d& a, const Vector3d& b,
               const Vector3d& h, double reflectance) {
  for (const Vector3d& offset : {Vector3d(Vector3d::Zero()), h}) {
    add_quad(mesh, c + offset, a, b, reflectance);
  }
  for (const Vector3d& offset : {Vector3d(Vector3d::Zero()), b}) {
    add_quad(mesh, c + offset, a, h, reflectance);
  }
  for (const Vector3d& offset : {Vector3d(Vector3d::Zero()), a}) {
    add_quad(mesh, c + offset, b, h, reflectance);
  }
}

}  // namespace

Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex.cast<double>());
  return box;
}

void add_mesh(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  mesh.reflectance.insert(mesh.reflectance.end(), other.reflectance.begin(),
                          other.reflectance.end());
  for (const auto& [a, b, c] : other.triangles) {
    mesh.triangles.push_back({a + offset, b + offset, c + offset});
  }
}

void add_quad(TriangleMesh& mesh, const Vector3d& c, const Vector3d& a, const Vector3d& b,
              double reflectance) {
  const std::uint32_t i = add_vertex(mesh, c, reflectance);
  add_vertex(mesh, c + a, reflectance);
  add_vertex(mesh, c + a + b, reflectance);
  add_vertex(mesh, c + b, reflectance);
  mesh.triangles.push_back({i, i + 1, i + 2});
  mesh.triangles.push_back({i, i + 2, i + 3});
}

void add_box(TriangleMesh& mesh, const Vector3d& min, const Vector3d& max, double reflectance) {
  add_rotated_box(mesh, min, max, 0, reflectance);
}

void add_rotated_box(TriangleMesh& mesh, const Vector3d& min, const Vector3d& max, double yaw_rad,
                     double reflectance) {
  const Vector3d size = max - min;
  const Eigen::AngleAxisd turn(yaw_rad, Vector3d::UnitZ());
  const Vector3d middle = (min + max) / 2;
  add_block(mesh, middle - turn * (size / 2), turn * Vector3d(size.x(), 0, 0),
            turn * Vector3d(0, size.y(), 0), Vector3d(0, 0, size.z()), reflectance);
}

void add_cylinder(TriangleMesh& mesh, const Vector3d& base, double radius_m, double height_m,
                  double reflectance) {
  constexpr int sides = 24;
  const Vector3d up(0, 0, height_m);
  const auto rim = [&](int side) -> Vector3d {
    const double angle = 2 * std::numbers::pi * side / sides;
    return base + radius_m * Vector3d(std::cos(angle), std::sin(angle), 0);
  };
  for (int side = 0; side < sides; ++side) {
    const Vector3d edge = rim(side + 1) - rim(side);
    add_quad(mesh, rim(side), edge, up, reflectance);
    for (const Vector3d& centre : {base, Vector3d(base + up)}) {
      const Vector3d lift = centre - base;
      const std::uint32_t i = add_vertex(mesh, centre, reflectance);
      add_vertex(mesh, rim(side) + lift, reflectance);
      add_vertex(mesh, rim(side + 1) + lift, reflectance);
      mesh.triangles.push_back({i, i + 1, i + 2});
    }
  }
}

void add_wall(TriangleMesh& mesh, const Vector3d& from, const Vector3d& to, double height_m,
              double thickness_m, const std::vector<WallOpening>& openings, double reflectance) {
  const Vector3d along = (to - from).normalized();
  const Vector3d across = thickness_m * Vector3d::UnitZ().cross(along);
  const auto piece = [&](double start, double stop, double bottom, double top) {
    if (stop <= start || top <= bottom) return;
    add_block(mesh, from + start * along + Vector3d(0, 0, bottom), (stop - start) * along, across,
              Vector3d(0, 0, top - bottom), reflectance);
  };
  double done = 0;
  for (const WallOpening& opening : openings) {
    piece(done, opening.from_m, 0, height_m);
    piece(opening.from_m, opening.to_m, 0, opening.bottom_m);
    piece(opening.from_m, opening.to_m, opening.top_m, height_m);
    done = opening.to_m;
  }
  piece(done, (to - from).norm(), 0, height_m);
}

}  // namespace tofmap
