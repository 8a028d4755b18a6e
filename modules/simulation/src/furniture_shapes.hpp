// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

// Meshes of furniture, metres. Each fills the box from `min` to `max` unless it says otherwise.

TriangleMesh box_shape(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double reflectance);

/// The box rotated by `yaw_rad` about the vertical axis through its centre.
TriangleMesh rotated_box_shape(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                               double yaw_rad, double reflectance);

/// An upright cylinder. `base` is the centre of its lower end.
TriangleMesh cylinder_shape(const Eigen::Vector3d& base, double radius_m, double height_m,
                            double reflectance);

/// A table top on four legs.
TriangleMesh table_shape(const Eigen::Vector3d& min, const Eigen::Vector3d& max,
                         double reflectance);

/// A chair on one leg. `seat` is the point of the floor beneath its middle.
TriangleMesh chair_shape(const Eigen::Vector3d& seat, double yaw_rad, double reflectance);

/// Open shelves: a back, two sides and boards. The open side faces +y if `faces_y`, otherwise −y.
TriangleMesh shelf_shape(const Eigen::Vector3d& min, const Eigen::Vector3d& max, bool faces_y,
                         double reflectance);

TriangleMesh sofa_shape(const Eigen::Vector3d& min, const Eigen::Vector3d& max, double reflectance);

}  // namespace tofmap
