// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "any_cloud_file.hpp"

#include "cloud_headers.hpp"
#include "legacy_vtk.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <stdexcept>

#include <pcl/console/print.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>
#include <vtkErrorCode.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObject.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

/// Suppresses VTK's messages on the terminal during its lifetime. Callers get exceptions instead.
class QuietVtk {
 public:
  QuietVtk() {
    vtkObject::GlobalWarningDisplayOff();
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  QuietVtk(const QuietVtk&) = delete;
  QuietVtk& operator=(const QuietVtk&) = delete;
  ~QuietVtk() {
    vtkObject::GlobalWarningDisplayOn();
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_INFO);
  }
};

/// A cloud with the fields x, y and z as doubles.
pcl::PCLPointCloud2 cloud_of(const std::vector<Eigen::Vector3d>& positions) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
  pcl::PCLPointCloud2 cloud;
  for (int axis = 0; axis < 3; ++axis) {
    pcl::PCLPointField field;
    field.name = std::string(1, static_cast<char>('x' + axis));
    field.offset = static_cast<std::uint32_t>(axis * sizeof(double));
    field.datatype = pcl::PCLPointField::FLOAT64;
    field.count = 1;
    cloud.fields.push_back(field);
  }
  cloud.point_step = sizeof(Eigen::Vector3d);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(positions.size());
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(positions.size() * cloud.point_step);
  if (!positions.empty()) std::memcpy(cloud.data.data(), positions.data(), cloud.data.size());
  return cloud;
}

std::vector<Eigen::Vector3d> read_vtp(const std::filesystem::path& file) {
  const QuietVtk quiet;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  if (reader->GetErrorCode() != vtkErrorCode::NoError) {
    throw InputError("cannot be parsed; is the file complete?");
  }
  vtkPoints* points = reader->GetOutput()->GetPoints();
  const vtkIdType count = points == nullptr ? 0 : points->GetNumberOfPoints();
  std::vector<Eigen::Vector3d> positions(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i) {
    points->GetPoint(i, positions[static_cast<std::size_t>(i)].data());
  }
  return positions;
}

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

/// Reads a file in the format that its ending names. Returns false if that fails, or if the header
/// states more points than fit into memory. Throws InputError for other endings, and for damage
/// that is known.
bool read_by_ending(const std::filesystem::path& file, AnyCloud& cloud) try {
  const QuietPcl quiet;
  const std::string kind = lower_extension(file);
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  int version = 0;
  int status = 0;
  if (kind == ".ply") {
    check_ply_header(file);
    status = pcl::PLYReader().read(file.string(), cloud.data, origin, orientation, version);
  } else if (kind == ".pcd") {
    check_pcd_header(file);
    status = pcl::PCDReader().read(file.string(), cloud.data, origin, orientation, version);
  } else if (kind == ".vtk") {
    cloud.data = cloud_of(read_legacy_vtk(file));
  } else if (kind == ".vtp") {
    cloud.data = cloud_of(read_vtp(file));
  } else {
    throw InputError("not a .ply, .pcd, .vtk or .vtp file; convert it to one of these formats");
  }
  // Writers that know no pose state the identity.
  constexpr float no_rotation_rad = 1e-3F;
  const float rotation_rad = orientation.angularDistance(Eigen::Quaternionf::Identity());
  if (!origin.head<3>().isZero(0) || rotation_rad > no_rotation_rad) {
    cloud.viewpoint = origin.head<3>().cast<double>();
  }
  return status >= 0;
} catch (const std::bad_alloc&) {
  return false;
} catch (const std::length_error&) {
  return false;
}

constexpr bool with_camera = false;

bool is_pcd(const std::filesystem::path& file) { return lower_extension(file) == ".pcd"; }

bool write_points(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud) {
  constexpr bool binary = true;
  try {
    if (is_pcd(file)) return pcl::PCDWriter().writeBinary(file.string(), cloud) == 0;
    return pcl::PLYWriter().write(file.string(), cloud, Eigen::Vector4f::Zero(),
                                  Eigen::Quaternionf::Identity(), binary, with_camera) == 0;
  } catch (const std::exception&) {
    return false;
  }
}

/// Writes a file without points, which PCL's writers refuse.
bool write_header(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud) {
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  const Eigen::Quaternionf upright = Eigen::Quaternionf::Identity();
  std::ofstream out(file);
  if (is_pcd(file)) {
    out << pcl::PCDWriter().generateHeaderBinary(cloud, origin, upright) << "DATA binary\n";
  } else {
    out << pcl::PLYWriter().generateHeaderBinary(cloud, origin, upright, 0, with_camera);
  }
  return static_cast<bool>(out.flush());
}

}  // namespace

QuietPcl::QuietPcl() : level_(pcl::console::getVerbosityLevel()) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
}

QuietPcl::~QuietPcl() {
  pcl::console::setVerbosityLevel(static_cast<pcl::console::VERBOSITY_LEVEL>(level_));
}

const pcl::PCLPointField* find_field(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  const auto found = std::ranges::find(cloud.fields, name, &pcl::PCLPointField::name);
  return found == cloud.fields.end() ? nullptr : &*found;
}

std::vector<Eigen::Vector3d> finite_positions(const pcl::PCLPointCloud2& cloud) {
  const std::array<const pcl::PCLPointField*, 3> axes{
      find_field(cloud, "x"), find_field(cloud, "y"), find_field(cloud, "z")};
  std::vector<Eigen::Vector3d> positions;
  const std::size_t step = cloud.point_step;
  for (std::size_t at = 0; step > 0 && at + step <= cloud.data.size(); at += step) {
    Eigen::Vector3d position;
    for (int axis = 0; axis < 3; ++axis) {
      const pcl::PCLPointField& field = *axes[static_cast<std::size_t>(axis)];
      position[axis] = value_at(cloud.data.data() + at + field.offset, field.datatype);
    }
    if (position.allFinite() && !position.isZero(0)) positions.push_back(position);
  }
  return positions;
}

AnyCloud read_any_cloud(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) {
    throw InputError(file.string() + ": is a folder; name the clouds in it");
  }
  refuse_no_file(file);
  if (!std::filesystem::exists(file)) {
    throw InputError(file.string() + ": no such file");
  }
  AnyCloud cloud;
  const bool is_read = naming(file.string(), [&] { return read_by_ending(file, cloud); });
  const bool has_points = find_field(cloud.data, "x") != nullptr &&
                          find_field(cloud.data, "y") != nullptr &&
                          find_field(cloud.data, "z") != nullptr;
  if (!is_read || !has_points) {
    throw InputError(file.string() + ": no point cloud could be read; is the file complete?");
  }
  return cloud;
}

void write_any_cloud(const std::filesystem::path& file, const pcl::PCLPointCloud2& cloud,
                     std::size_t bytes_per_point) {
  const QuietPcl quiet;
  const std::size_t points = std::size_t{cloud.width} * cloud.height;
  const bool written = points == 0 ? write_header(file, cloud) : write_points(file, cloud);
  // PCL does not report a full disk. The file is then smaller than its points.
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(file, missing);
  if (!written || missing || bytes < points * bytes_per_point) {
    throw InputError(file.string() + ": cannot be written; is the disk full?");
  }
}

}  // namespace tofmap
