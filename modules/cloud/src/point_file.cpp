// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/point_file.hpp"

#include "any_cloud_file.hpp"

#include <array>
#include <cstring>

#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

template <class Number>
double number_at(const std::uint8_t* bytes) {
  Number value;
  std::memcpy(&value, bytes, sizeof(value));
  return static_cast<double>(value);
}

double value_at(const std::uint8_t* bytes, std::uint8_t datatype) {
  using Field = pcl::PCLPointField;
  switch (datatype) {
    case Field::INT8:
      return number_at<std::int8_t>(bytes);
    case Field::UINT8:
      return number_at<std::uint8_t>(bytes);
    case Field::INT16:
      return number_at<std::int16_t>(bytes);
    case Field::UINT16:
      return number_at<std::uint16_t>(bytes);
    case Field::INT32:
      return number_at<std::int32_t>(bytes);
    case Field::UINT32:
      return number_at<std::uint32_t>(bytes);
    case Field::FLOAT32:
      return number_at<float>(bytes);
    default:
      return number_at<double>(bytes);
  }
}

}  // namespace

PointSet read_points(const std::filesystem::path& file) {
  const AnyCloud cloud = read_any_cloud(file);
  const std::array<const pcl::PCLPointField*, 3> axes{
      find_field(cloud.data, "x"), find_field(cloud.data, "y"), find_field(cloud.data, "z")};
  PointSet out;
  const std::size_t step = cloud.data.point_step;
  for (std::size_t at = 0; step > 0 && at + step <= cloud.data.data.size(); at += step) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const pcl::PCLPointField& field = *axes[static_cast<std::size_t>(axis)];
      point[axis] = value_at(cloud.data.data.data() + at + field.offset, field.datatype);
    }
    if (point.allFinite() && !point.isZero(0)) out.points.push_back(point);
  }
  if (out.points.empty()) {
    throw InputError(file.string() + ": holds no point that is finite; is it the right file?");
  }
  if (!cloud.viewpoint.isZero(0)) out.viewpoint = cloud.viewpoint;
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
