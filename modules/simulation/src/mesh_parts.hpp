// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/simulation/scenes.hpp>

namespace tofmap {

/// The axis-aligned bounding box of the vertices of a part. Empty if there are none.
Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, const MeshPart& part);

/// The mesh without some of its parts. What remains keeps its order.
TriangleMesh without_parts(const TriangleMesh& mesh, const std::vector<MeshPart>& parts);

/// Removes pieces that are gone from the surface of a scene, and updates the parts of all pieces.
void remove_gone(Scene& scene);

/// Centres of at most 40 triangles of a part.
std::vector<Eigen::Vector3d> sample_points(const TriangleMesh& mesh, const MeshPart& part);

}  // namespace tofmap
