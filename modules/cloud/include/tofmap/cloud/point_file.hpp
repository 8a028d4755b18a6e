// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// Points of any origin, in a frame and a unit of their own, in the order of their file.
struct PointSet {
  std::vector<Eigen::Vector3d> points;       ///< all finite
  std::optional<Eigen::Vector3d> viewpoint;  ///< where the sensor stood, if the file says so
};

/// Reads the positions of a PLY, PCD or VTK (.vtk, .vtp) file, whatever else it holds and whatever
/// numbers they are stored as. Points that are not finite are left out, and so are those at exactly
/// (0, 0, 0), which sensors write for no return. Throws InputError that names the file if it cannot
/// be read or holds no point.
PointSet read_points(const std::filesystem::path& file);

/// Writes a binary PLY with properties x y z label, the label being the cloud that a point is of,
/// by its place in `clouds`. Throws InputError that names the file if it cannot be written whole.
void write_labelled_points(const std::filesystem::path& file,
                           const std::vector<std::vector<Eigen::Vector3d>>& clouds);

}  // namespace tofmap
