// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "rows.hpp"

#include "../state_json.hpp"

#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

#include <tofmap/core/bytes.hpp>

namespace tofmap {
namespace {

constexpr int translation_columns = 3;

/// Larger coordinates are damage. Voxels of a centimetre reach as far.
constexpr double farthest_position_m = 1e4;

template <class Number>
void read_all(SQLite::Statement& row, int index, std::span<Number> numbers) {
  const SQLite::Column column = row.getColumn(index);
  ByteReader bytes(bytes_in(column));
  bytes.numbers(numbers);
  bytes.expect_end();
}

}  // namespace

void bind_pose(SQLite::Statement& statement, int first, const Pose& pose) {
  int index = first;
  for (const double coordinate : Eigen::Vector3d(pose.translation())) {
    statement.bind(index++, coordinate);
  }
  const Eigen::Quaterniond rotation(pose.linear());
  for (const double coordinate : {rotation.x(), rotation.y(), rotation.z(), rotation.w()}) {
    statement.bind(index++, coordinate);
  }
  const Eigen::Matrix3d matrix = pose.linear();
  statement.bind(index, matrix.data(), static_cast<int>(sizeof(double) * matrix.size()));
}

Pose pose_in(SQLite::Statement& row, int first) {
  Pose pose = Pose::Identity();
  for (int axis = 0; axis < translation_columns; ++axis) {
    pose.translation()[axis] = position_in(row, first + axis);
  }
  Eigen::Matrix3d matrix;
  read_numbers(row, first + pose_columns - 1, matrix.data(), static_cast<int>(matrix.size()));
  check_rotation(matrix);
  pose.linear() = matrix;
  return pose;
}

void bind_numbers(SQLite::Statement& statement, int index, const double* numbers, int count) {
  statement.bindNoCopy(index, numbers, static_cast<int>(sizeof(double)) * count);
}

void bind_numbers(SQLite::Statement& statement, int index, const float* numbers, int count) {
  statement.bindNoCopy(index, numbers, static_cast<int>(sizeof(float)) * count);
}

void read_numbers(SQLite::Statement& row, int index, double* numbers, int count) {
  read_all(row, index, std::span(numbers, static_cast<std::size_t>(count)));
}

void read_numbers(SQLite::Statement& row, int index, float* numbers, int count) {
  read_all(row, index, std::span(numbers, static_cast<std::size_t>(count)));
}

double number_in(SQLite::Statement& row, int index) {
  const SQLite::Column column = row.getColumn(index);
  const double number = column.getDouble();
  if ((!column.isFloat() && !column.isInteger()) || !(std::abs(number) <= largest_number)) {
    throw InputError(std::string("column '") + column.getName() + "' has no plausible number");
  }
  return number;
}

double position_in(SQLite::Statement& row, int index) {
  const double position_m = number_in(row, index);
  if (std::abs(position_m) > farthest_position_m) {
    throw InputError("a position is more than 10 km from the origin");
  }
  return position_m;
}

int integer_in(SQLite::Statement& row, int index, int least, int most) {
  const SQLite::Column column = row.getColumn(index);
  const std::int64_t number = column.getInt64();
  if (!column.isInteger() || number < least || number > most) {
    throw InputError(std::string("column '") + column.getName() + "' is not a number from " +
                     std::to_string(least) + " to " + std::to_string(most));
  }
  return static_cast<int>(number);
}

std::string sensor_json(const SensorModel& sensor) {
  const CameraModel& camera = sensor.camera;
  return Json{{"width_px", camera.width_px},
              {"height_px", camera.height_px},
              {"fx_px", camera.fx_px},
              {"fy_px", camera.fy_px},
              {"cx_px", camera.cx_px},
              {"cy_px", camera.cy_px},
              {"distortion", camera.distortion},
              {"frequencies_hz", sensor.modulation.frequencies_hz},
              {"exposure_offsets_s", sensor.modulation.exposure_offsets_s},
              {"max_range_m", sensor.max_range_m},
              {"saturation_amplitude", sensor.saturation_amplitude}}
      .dump();
}

SensorModel sensor_in(const std::string& json) {
  const Json value = Json::parse(json, nullptr, false);
  SensorModel sensor;
  CameraModel& camera = sensor.camera;
  camera.width_px = integer_in(value, "width_px", 1, most_pixels);
  camera.height_px = integer_in(value, "height_px", 1, most_pixels);
  camera.fx_px = number_in(value, "fx_px");
  camera.fy_px = number_in(value, "fy_px");
  camera.cx_px = number_in(value, "cx_px");
  camera.cy_px = number_in(value, "cy_px");
  const Json& distortion = list_in(value, "distortion");
  if (distortion.size() != camera.distortion.size()) {
    throw InputError("'distortion' does not have five numbers");
  }
  for (std::size_t i = 0; i < distortion.size(); ++i) {
    camera.distortion[i] = number_in(distortion[i]);
  }
  validate(camera);
  for (const Json& frequency : list_in(value, "frequencies_hz")) {
    sensor.modulation.frequencies_hz.push_back(number_in(frequency));
  }
  for (const Json& offset : list_in(value, "exposure_offsets_s")) {
    sensor.modulation.exposure_offsets_s.push_back(number_in(offset));
  }
  if (sensor.modulation.count() > most_frequencies) throw InputError("too many frequencies");
  sensor.max_range_m = number_in(value, "max_range_m");
  sensor.saturation_amplitude = number_in(value, "saturation_amplitude");
  return sensor;
}

std::string surface_options_json(const SurfaceMapOptions& options) {
  return Json{{"voxel_m", options.voxel_m},
              {"min_observations", options.min_observations},
              {"max_sigma_m", options.max_sigma_m},
              {"drop_free_space_violations", options.drop_free_space_violations}}
      .dump();
}

SurfaceMapOptions surface_options_in(const std::string& json) {
  const Json value = Json::parse(json, nullptr, false);
  SurfaceMapOptions options;
  options.voxel_m = number_in(value, "voxel_m");
  options.min_observations = integer_in(value, "min_observations", 1);
  options.max_sigma_m = number_in(value, "max_sigma_m");
  options.drop_free_space_violations = flag_in(value, "drop_free_space_violations");
  for (const OptionField<SurfaceMapOptions>& field : SurfaceMapOptions::fields()) {
    const auto* number = std::get_if<double SurfaceMapOptions::*>(&field.member);
    if (number == nullptr || (options.**number >= field.min && options.**number <= field.max)) {
      continue;
    }
    throw InputError("'" + std::string(field.name) + "' is out of its range");
  }
  return options;
}

}  // namespace tofmap
