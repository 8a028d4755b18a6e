// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/start_place.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include <CLI/CLI.hpp>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace {

/// Numbers between commas. Empty if the text has anything else.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    std::istringstream in(part);
    double number = 0;
    if (!(in >> number) || !(in >> std::ws).eof() || !std::isfinite(number)) return {};
    numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

void add_start_option(CLI::App& command, std::string& start) {
  command.add_option("--start", start,
                     "where the camera begins in the map, to half a metre: the id of a keyframe, "
                     "x,y,z, or x,y,z,qx,qy,qz,qw");
}

std::optional<MapPlace> start_place(const std::string& argument, const MapContent& map) {
  if (argument.empty()) return std::nullopt;
  constexpr std::size_t position_numbers = 3;
  constexpr std::size_t pose_numbers = 7;
  const std::vector<double> numbers = numbers_in(argument);
  const int keyframes = map.keyframes.size();
  if (numbers.size() == 1) {
    const double id = numbers.front();
    if (id != std::floor(id) || id < 0 || id >= keyframes) {
      throw UsageError("--start " + argument + ": the map has keyframes 0 to " +
                       std::to_string(keyframes - 1));
    }
    const Keyframe& keyframe = map.keyframes[static_cast<int>(id)];
    return MapPlace{keyframe.map, keyframe.world_from_camera};
  }
  MapPlace place{.map = largest_map(map), .has_rotation = numbers.size() == pose_numbers};
  if (numbers.size() != position_numbers && !place.has_rotation) {
    throw UsageError("--start " + argument +
                     ": is neither the id of a keyframe, nor x,y,z, nor x,y,z,qx,qy,qz,qw");
  }
  place.world_from_camera.translation() << numbers[0], numbers[1], numbers[2];
  if (place.has_rotation) {
    const Eigen::Quaterniond rotation(numbers[6], numbers[3], numbers[4], numbers[5]);
    if (!(rotation.norm() > 0)) throw UsageError("--start " + argument + ": the rotation is zero");
    place.world_from_camera.linear() = rotation.normalized().toRotationMatrix();
  }
  return place;
}

}  // namespace tofmap::app
