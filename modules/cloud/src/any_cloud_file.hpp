// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <pcl/PCLPointCloud2.h>

namespace tofmap {

/// Suppresses PCL's messages on the terminal during its lifetime. Callers get exceptions instead.
class QuietPcl {
 public:
  QuietPcl();
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;
  ~QuietPcl();

 private:
  int level_;
};

/// A cloud with the fields of its file, which include x, y and z.
struct AnyCloud {
  pcl::PCLPointCloud2 data;
  std::optional<Eigen::Vector3d> viewpoint;  ///< empty if the file states no pose of the sensor
};

/// Reads a PLY, PCD or VTK (.vtk, .vtp) file. Of a VTK file, only positions are read. Throws
/// InputError, which names the file, if it cannot be read.
AnyCloud read_any_cloud(const std::filesystem::path& file);

/// Positions of the points, which may be stored as any type of number. Points that are not finite
/// or at exactly (0, 0, 0) are dropped. The cloud must have the fields x, y and z.
std::vector<Eigen::Vector3d> finite_positions(const pcl::PCLPointCloud2& cloud);

/// Writes a binary PCD file if the name ends in .pcd, otherwise a binary PLY file. Throws
/// InputError, which names the file, if it cannot be written completely: a file that is smaller
/// than `bytes_per_point` times the number of points is incomplete.
void write_any_cloud(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud,
                     std::size_t bytes_per_point);

/// The field of this name, or nullptr if the cloud has none.
const pcl::PCLPointField* find_field(const pcl::PCLPointCloud2& cloud, const std::string& name);

}  // namespace tofmap
