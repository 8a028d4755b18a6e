// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <tofmap/cloud/range_limit.hpp>

namespace tofmap {

/// The points of a file, in the frame and the unit of length of the file, and in its order.
struct PointSet {
  std::vector<Eigen::Vector3d> points;  ///< all finite
  /// Position of the sensor. Empty if the file does not state it.
  std::optional<Eigen::Vector3d> viewpoint = std::nullopt;
  /// The limit of range whose points were removed. Empty if none was looked for, or found.
  std::optional<RangeLimit> limit = std::nullopt;
};

/// Reads the positions of a PLY, PCD or VTK (.vtk, .vtp) file. They may be stored as any type of
/// number; other properties are ignored. Points that are not finite are dropped, and so are points
/// at exactly (0, 0, 0), which sensors write for pixels without a return. A viewpoint at (0, 0, 0)
/// without a rotation counts as none. Throws InputError, which names the file, if it cannot be read
/// or has no points.
PointSet read_points(const std::filesystem::path& file);

/// Writes all clouds into one binary PLY file with properties x y z label, where the label is the
/// index of the point's cloud; a binary PCD file if the name ends in .pcd. Throws InputError, which
/// names the file, if it cannot be written completely.
void write_labelled_points(const std::filesystem::path& file,
                           const std::vector<std::vector<Eigen::Vector3d>>& clouds);

}  // namespace tofmap
