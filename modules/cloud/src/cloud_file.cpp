// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/cloud_file.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

bool has_field(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  return std::ranges::any_of(cloud.fields, [&](const auto& field) { return field.name == name; });
}

/// PCL prints to the terminal on its own account; our callers get errors instead.
class QuietPcl {
 public:
  QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
    pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  }
  QuietPcl(const QuietPcl&) = delete;
  QuietPcl& operator=(const QuietPcl&) = delete;
  ~QuietPcl() { pcl::console::setVerbosityLevel(level_); }

 private:
  pcl::console::VERBOSITY_LEVEL level_;
};

pcl::PCLPointCloud2 read_any(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw InputError(file.string() + ": no such file");
  }
  const QuietPcl quiet;
  pcl::PCLPointCloud2 cloud;
  const std::string kind = file.extension().string();
  int status = -1;
  if (kind == ".ply") {
    status = pcl::PLYReader().read(file.string(), cloud);
  } else if (kind == ".pcd") {
    status = pcl::PCDReader().read(file.string(), cloud);
  } else {
    throw InputError(file.string() + ": neither .ply nor .pcd; convert it to one of them");
  }
  if (status < 0 || !has_field(cloud, "x") || !has_field(cloud, "y") || !has_field(cloud, "z")) {
    throw InputError(file.string() + ": no point cloud could be read from it; is it whole?");
  }
  return cloud;
}

constexpr bool with_camera = false;

bool write_points(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud) {
  constexpr bool binary = true;
  try {
    return pcl::PLYWriter().write(file.string(), cloud, Eigen::Vector4f::Zero(),
                                  Eigen::Quaternionf::Identity(), binary, with_camera) == 0;
  } catch (const std::exception&) {
    return false;
  }
}

/// PCL's writer refuses a cloud without points, though its header is a whole file.
bool write_header(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud) {
  std::ofstream out(file);
  out << pcl::PLYWriter().generateHeaderBinary(cloud, Eigen::Vector4f::Zero(),
                                               Eigen::Quaternionf::Identity(), 0, with_camera);
  return static_cast<bool>(out.flush());
}

}  // namespace

void write_map(const std::filesystem::path& file, const MapCloud& map) {
  const QuietPcl quiet;
  pcl::PCLPointCloud2 cloud;
  pcl::toPCLPointCloud2(map, cloud);
  const bool written = map.empty() ? write_header(file, cloud) : write_points(file, cloud);
  // PCL does not notice a full disk: the file then is shorter than its points.
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  constexpr std::size_t bytes_per_point = 7 * sizeof(float) + sizeof(std::uint32_t);
  if (!written || missing || bytes < map.size() * bytes_per_point) {
    throw InputError(file.string() + ": cannot be written whole; is the disk full?");
  }
}

MapCloud read_map(const std::filesystem::path& file) {
  const pcl::PCLPointCloud2 cloud = read_any(file);
  const QuietPcl quiet;
  MapCloud map;
  if (cloud.data.empty()) return map;  // PCL would take the address of a point there is not
  pcl::fromPCLPointCloud2(cloud, map);
  for (MapPoint& point : map.points) {
    if (!has_field(cloud, "normal_x")) point.normal_x = point.normal_y = point.normal_z = nan;
    if (!has_field(cloud, "confidence")) point.confidence = 1;
    if (!has_field(cloud, "observations")) point.observations = 1;
  }
  return map;
}

}  // namespace tofmap
