// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace tofmap {

/// A point that has changed between recordings: position in metres, unit normal, colour, what has
/// become of it (`kind`), the change that it is part of, and the recording that shows it.
struct EIGEN_ALIGN16 ChangedPoint {
  PCL_ADD_POINT4D;
  PCL_ADD_NORMAL4D;
  PCL_ADD_RGB;
  std::uint32_t kind;
  std::uint32_t change;
  std::uint32_t recording;
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

/// Writes a binary PLY file with the properties x y z nx ny nz red green blue kind change
/// recording. Throws InputError, which names the file, if it cannot be written completely.
void write_changed_points(const std::filesystem::path& file,
                          const pcl::PointCloud<ChangedPoint>& points);

}  // namespace tofmap

// clang-format off
POINT_CLOUD_REGISTER_POINT_STRUCT(tofmap::ChangedPoint,
    (float, x, x)(float, y, y)(float, z, z)
    (float, normal_x, normal_x)(float, normal_y, normal_y)(float, normal_z, normal_z)
    (float, rgb, rgb)(std::uint32_t, kind, kind)(std::uint32_t, change, change)
    (std::uint32_t, recording, recording))
// clang-format on
