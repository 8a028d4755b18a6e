// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/surface_mesh.hpp>

namespace tofmap {

/// The surface that a map's points lie on.
///
/// Distances to the points' planes are averaged at the corners of a grid, up to two voxels from the
/// points (an implicit surface as of Hoppe et al., SIGGRAPH 1992, kept only near the points: memory
/// follows the surface), and the surface is where they are zero (VTK's vtkContour3DLinearGrid).
/// There is none where a cell has a corner far from all points, so holes of the map stay open, but
/// for those a few voxels wide. Of both sides of a panel thinner than that the one that comes first
/// in the map is taken. The result is the same for any number of threads.
///
/// Throws UsageError if the voxels are too small for the extent of the map.
SurfaceMesh extract_mesh(const MapCloud& map, double voxel_m);

}  // namespace tofmap
