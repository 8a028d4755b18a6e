// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// A point of a map: position in metres and unit normal, both in the world frame; the mean
/// confidence of its observations, that is, the probability that their wrap counts are right; the
/// number of observations; and, which files do not have, the index of the recording in which it was
/// first seen (MapContent::recordings).
struct EIGEN_ALIGN16 MapPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  float confidence;
  std::uint32_t observations;
  std::uint32_t recording = 0;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

using MapCloud = pcl::PointCloud<MapPoint>;

/// Writes a binary PCD file if the name ends in .pcd, otherwise a binary PLY file. Its properties
/// are x y z nx ny nz (PCD: normal_x …) confidence observations. Throws InputError, which names the
/// file, if it cannot be written completely.
void write_map(const std::filesystem::path& file, const MapCloud& map);

/// Reads a PLY, PCD or VTK (.vtk, .vtp) file. Points that are not finite are dropped. Normals,
/// confidence and observations that the file does not have are NaN, 1 and 1. If positions are not
/// stored as 32-bit floats, and from VTK files, only positions are read, and points at exactly
/// (0, 0, 0) are dropped as well. Throws InputError, which names the file, if it cannot be read.
MapCloud read_map(const std::filesystem::path& file);

}  // namespace tofmap

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(tofmap::MapPoint,
    (float, x, x)(float, y, y)(float, z, z)
    (float, normal_x, normal_x)(float, normal_y, normal_y)(float, normal_z, normal_z)
    (float, confidence, confidence)(std::uint32_t, observations, observations))
// clang-format on
