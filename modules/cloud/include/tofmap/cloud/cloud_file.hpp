// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap {

/// A point of a map: position and unit normal in the world frame (metres), the probability
/// that it is a true surface, and how many observations support it.
struct EIGEN_ALIGN16 MapPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  float confidence;
  std::uint32_t observations;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

using MapCloud = pcl::PointCloud<MapPoint>;

/// Writes a binary PLY (or PCD, if the file is named so) with properties x y z nx ny nz (PCD:
/// normal_x …) confidence observations.
/// Throws InputError that names the file if it cannot be written whole.
void write_map(const std::filesystem::path& file, const MapCloud& map);

/// Reads a PLY, PCD or VTK cloud; normals, confidence and observations that the file does not
/// have are NaN, 1 and 1. Throws InputError that names the file if it cannot be read.
MapCloud read_map(const std::filesystem::path& file);

}  // namespace tofmap

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(tofmap::MapPoint,
    (float, x, x)(float, y, y)(float, z, z)
    (float, normal_x, normal_x)(float, normal_y, normal_y)(float, normal_z, normal_z)
    (float, confidence, confidence)(std::uint32_t, observations, observations))
// clang-format on
