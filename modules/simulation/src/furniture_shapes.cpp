// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "furniture_shapes.hpp"

namespace tofmap {

using Eigen::Vector3d;

TriangleMesh box_shape(const Vector3d& min, const Vector3d& max, double reflectance) {
  TriangleMesh mesh;
  add_box(mesh, min, max, reflectance);
  return mesh;
}

TriangleMesh rotated_box_shape(const Vector3d& min, const Vector3d& max, double yaw_rad,
                               double reflectance) {
  TriangleMesh mesh;
  add_rotated_box(mesh, min, max, yaw_rad, reflectance);
  return mesh;
}

TriangleMesh cylinder_shape(const Vector3d& base, double radius_m, double height_m,
                            double reflectance) {
  TriangleMesh mesh;
  add_cylinder(mesh, base, radius_m, height_m, reflectance);
  return mesh;
}

TriangleMesh table_shape(const Vector3d& min, const Vector3d& max, double reflectance) {
  constexpr double top = 0.05;
  constexpr double leg = 0.08;
  TriangleMesh mesh;
  add_box(mesh, {min.x(), min.y(), max.z() - top}, max, reflectance);
  for (const double x : {min.x(), max.x() - leg}) {
    for (const double y : {min.y(), max.y() - leg}) {
      add_box(mesh, {x, y, min.z()}, {x + leg, y + leg, max.z() - top}, 0.7 * reflectance);
    }
  }
  return mesh;
}

TriangleMesh chair_shape(const Vector3d& seat, double yaw_rad, double reflectance) {
  TriangleMesh mesh;
  const Vector3d half(0.22, 0.22, 0);
  add_rotated_box(mesh, seat - half + Vector3d(0, 0, 0.40), seat + half + Vector3d(0, 0, 0.46),
                  yaw_rad, reflectance);
  const Vector3d back = seat + Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()) * Vector3d(-0.2, 0, 0);
  add_rotated_box(mesh, back + Vector3d(-0.03, -0.22, 0.46), back + Vector3d(0.03, 0.22, 0.95),
                  yaw_rad, reflectance);
  add_cylinder(mesh, seat, 0.05, 0.4, reflectance);
  return mesh;
}

TriangleMesh shelf_shape(const Vector3d& min, const Vector3d& max, bool faces_y,
                         double reflectance) {
  constexpr double board = 0.03;
  TriangleMesh mesh;
  const double back = faces_y ? min.y() : max.y() - board;
  add_box(mesh, {min.x(), back, min.z()}, {max.x(), back + board, max.z()}, 0.8 * reflectance);
  add_box(mesh, min, {min.x() + board, max.y(), max.z()}, reflectance);
  add_box(mesh, {max.x() - board, min.y(), min.z()}, max, reflectance);
  constexpr int boards = 5;
  for (int i = 0; i < boards; ++i) {
    const double z = min.z() + i * (max.z() - min.z() - board) / (boards - 1);
    add_box(mesh, {min.x(), min.y(), z}, {max.x(), max.y(), z + board}, reflectance);
  }
  return mesh;
}

TriangleMesh sofa_shape(const Vector3d& min, const Vector3d& max, double reflectance) {
  TriangleMesh mesh;
  add_box(mesh, min, {max.x(), max.y(), 0.42}, reflectance);
  add_box(mesh, {min.x(), min.y(), 0.42}, {max.x(), min.y() + 0.22, max.z()}, reflectance);
  add_box(mesh, {min.x(), min.y(), 0.42}, {min.x() + 0.2, max.y(), 0.6}, reflectance);
  add_box(mesh, {max.x() - 0.2, min.y(), 0.42}, {max.x(), max.y(), 0.6}, reflectance);
  return mesh;
}

}  // namespace tofmap
