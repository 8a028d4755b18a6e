// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

namespace tofmap {

/// Copies points into a PCL cloud.
inline pcl::PointCloud<pcl::PointXYZ>::Ptr pcl_points(std::span<const Eigen::Vector3f> points_m) {
  auto cloud = std::make_shared<pcl::PointCloud<pcl::PointXYZ>>();
  cloud->reserve(points_m.size());
  for (const Eigen::Vector3f& at : points_m) cloud->push_back({at.x(), at.y(), at.z()});
  return cloud;
}

}  // namespace tofmap
