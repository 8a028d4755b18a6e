// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/change_file.hpp"

#include "any_cloud_file.hpp"

#include <pcl/conversions.h>

namespace tofmap {

void write_changed_points(const std::filesystem::path& file,
                          const pcl::PointCloud<ChangedPoint>& points) {
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(points, cloud);
  constexpr std::size_t color_bytes = 3;
  write_any_cloud(file, cloud, 6 * sizeof(float) + color_bytes + 3 * sizeof(std::uint32_t));
}

}  // namespace tofmap
