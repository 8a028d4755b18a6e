// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/point_file.hpp"

#include "any_cloud_file.hpp"

#include <cstdint>

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
PointSet read_points(const std::filesystem::path& file) {
  const AnyCloud cloud = read_any_cloud(file);
  PointSet out;
  out.points = finite_positions(cloud.data);
  if (out.points.empty()) {
    throw InputError(
        file.string() +
        ": has no points, apart from those at (0, 0, 0) or not finite; is it the right file?");
  }
  out.viewpoint = cloud.viewpoint;
  return out;
}

void write_labelled_points(const std::filesystem::path& file,
                           const std::vector<std::vector<Eigen::Vector3d>>& clouds) {
  pcl::PointCloud<pcl::PointXYZL> merged;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    for (const Eigen::Vector3d& point : clouds[i]) {
      const Eigen::Vector3f at = point.cast<float>();
      merged.push_back({at.x(), at.y(), at.z(), static_cast<std::uint32_t>(i)});
    }
  }
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(merged, cloud);
  write_any_cloud(file, cloud, 3 * sizeof(float) + sizeof(std::uint32_t));
}

}  // namespace tofmap
