// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/cloud/surface_mesh.hpp>

namespace tofmap {

/// Extracts a triangle mesh of the surface that a map's points lie on.
///
/// The signed distances to the planes of points within two voxels are averaged at the corners of a
/// grid (an implicit surface as by Hoppe et al., SIGGRAPH 1992, stored only near points). The mesh
/// is where the averaged distance is zero (VTK's vtkContour3DLinearGrid). A cell with a corner that
/// is far from all points has no surface, so holes of the map stay open unless they are only a few
/// voxels wide. Of a panel that is thinner than that, only the side that comes first in the map is
/// meshed. The result is empty if no cell has a surface, and is the same for any number of threads.
///
/// Throws UsageError if the voxels are too small for the extent of the map.
SurfaceMesh extract_mesh(const MapCloud& map, double voxel_m);

}  // namespace tofmap
