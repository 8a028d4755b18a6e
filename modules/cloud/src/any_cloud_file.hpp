// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <pcl/PCLPointCloud2.h>

namespace tofmap {

/// PCL prints to the terminal on its own account; our callers get errors instead.
class QuietPcl {
 public:
  QuietPcl();
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;
  ~QuietPcl();

 private:
  int level_;
};

/// The fields of a cloud as its file has them; x, y and z are among them.
struct AnyCloud {
  pcl::PCLPointCloud2 data;
  Eigen::Vector3d viewpoint = Eigen::Vector3d::Zero();  ///< zero, too, if the file has none
};

/// Reads a PLY, PCD or VTK (.vtk, .vtp) file. Throws InputError that names the file if it cannot be
/// read.
AnyCloud read_any_cloud(const std::filesystem::path& file);

/// Where points are, whatever numbers they are stored as; without those that are not finite or at
/// exactly (0, 0, 0). x, y and z must be among the fields.
std::vector<Eigen::Vector3d> finite_positions(const pcl::PCLPointCloud2& cloud);

/// Writes a binary PCD if the file is named .pcd, else a binary PLY. Throws InputError that names
/// the file if it cannot be written whole; a point takes `bytes_per_point` there.
void write_any_cloud(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud,
                     std::size_t bytes_per_point);

/// The field of that name, or nullptr.
const pcl::PCLPointField* find_field(const pcl::PCLPointCloud2& cloud, const std::string& name);

}  // namespace tofmap
