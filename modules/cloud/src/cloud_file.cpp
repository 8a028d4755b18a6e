// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/cloud_file.hpp"

#include "any_cloud_file.hpp"

#include <cmath>

#include <pcl/conversions.h>

namespace tofmap {
namespace {

MapCloud map_without_normals(const std::vector<Eigen::Vector3d>& positions) {
  MapCloud map;
  for (const Eigen::Vector3d& position : positions) {
    MapPoint point;
    point.getVector3fMap() = position.cast<float>();
    point.normal_x = point.normal_y = point.normal_z = nan;
    point.confidence = 1;
    point.observations = 1;
    map.push_back(point);
  }
  return map;
}

}  // namespace

void write_map(const std::filesystem::path& file, const MapCloud& map) {
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(map, cloud);
  write_any_cloud(file, cloud, 7 * sizeof(float) + sizeof(std::uint32_t));
}

MapCloud read_map(const std::filesystem::path& file) {
  const pcl::PCLPointCloud2 cloud = read_any_cloud(file).data;
  MapCloud map;
  if (cloud.data.empty()) return map;  // PCL would take the address of a point that does not exist
  // PCL does not convert numbers: it would ignore fields that are not stored as floats.
  if (find_field(cloud, "x")->datatype != pcl::PCLPointField::FLOAT32) {
    return map_without_normals(finite_positions(cloud));
  }
  const QuietPcl quiet;
  pcl::fromPCLPointCloud2(cloud, map);
  std::erase_if(map.points, [](const MapPoint& p) {
    return !std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z);
  });
  map.width = static_cast<std::uint32_t>(map.points.size());
  map.height = 1;
  const auto is_stored = [&](const char* field) { return find_field(cloud, field) != nullptr; };
  const bool has_normals = is_stored("normal_x");
  const bool has_confidence = is_stored("confidence");
  const bool has_observations = is_stored("observations");
  for (MapPoint& point : map.points) {
    if (!has_normals) point.normal_x = point.normal_y = point.normal_z = nan;
    if (!has_confidence) point.confidence = 1;
    if (!has_observations) point.observations = 1;
  }
  return map;
}

}  // namespace tofmap
