// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "page_scene.hpp"

#include "base64.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Json = nlohmann::ordered_json;
using Box = Eigen::AlignedBox3f;

Box box_of(const PageScene& scene) {
  Box box;
  for (const SceneCloud& cloud : scene.clouds) {
    for (const Eigen::Vector3f& point : cloud.points_m) box.extend(point);
  }
  for (const ScenePath& path : scene.paths) {
    for (const Eigen::Vector3f& point : path.points_m) box.extend(point);
  }
  if (box.isEmpty()) box = Box(Eigen::Vector3f::Zero(), Eigen::Vector3f::Ones());
  return box;
}

/// Coordinates as fractions of the box, in 65535 steps.
std::string packed_places(const std::vector<Eigen::Vector3f>& points_m, const Box& box) {
  const Eigen::Array3f steps = 65535 / box.sizes().array().max(1e-6F);
  std::vector<std::uint16_t> packed;
  for (const Eigen::Vector3f& point : points_m) {
    const Eigen::Array3f place = (point - box.min()).array() * steps;
    for (int i = 0; i < 3; ++i) packed.push_back(static_cast<std::uint16_t>(std::lround(place[i])));
  }
  return base64(packed);
}

std::string packed_normals(const std::vector<Eigen::Vector3f>& normals) {
  std::vector<std::int8_t> packed;
  for (const Eigen::Vector3f& normal : normals) {
    for (int i = 0; i < 3; ++i) {
      packed.push_back(
          static_cast<std::int8_t>(std::lround(127 * std::clamp(normal[i], -1.0F, 1.0F))));
    }
  }
  return base64(packed);
}

Json json_of(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

Json json_of(const SceneCloud& cloud, const Box& box) {
  Json colorings = Json::array();
  for (const std::vector<Rgb>& colors : cloud.colorings) colorings.push_back(base64(colors));
  return {{"name", cloud.name},
          {"points", packed_places(cloud.points_m, box)},
          {"normals", packed_normals(cloud.normals)},
          {"colorings", std::move(colorings)}};
}

Json json_of(const ScenePath& path, const Box& box) {
  const int color = path.color.red << 16 | path.color.green << 8 | path.color.blue;
  return {{"name", path.name}, {"points", packed_places(path.points_m, box)}, {"color", color}};
}

void check(const PageScene& scene) {
  for (const SceneCloud& cloud : scene.clouds) {
    const auto as_many = [&](const std::vector<Rgb>& colors) {
      return colors.size() == cloud.points_m.size();
    };
    const auto is_finite = [](const Eigen::Vector3f& v) { return v.allFinite(); };
    if (!std::ranges::all_of(cloud.points_m, is_finite) ||
        !std::ranges::all_of(cloud.normals, is_finite)) {
      throw UsageError("page: cloud '" + cloud.name +
                       "' has points or normals that are not finite");
    }
    if (cloud.normals.size() != cloud.points_m.size() ||
        cloud.colorings.size() != scene.colorings.size() ||
        !std::ranges::all_of(cloud.colorings, as_many)) {
      throw UsageError("page: cloud '" + cloud.name +
                       "' has the wrong number of normals, colours or colourings");
    }
  }
}

}  // namespace

std::string scene_json(const PageScene& scene) {
  check(scene);
  const Box box = box_of(scene);
  Json json = {{"box", {{"min", json_of(box.min())}, {"max", json_of(box.max())}}},
               {"point_size_m", scene.point_size_m},
               {"clouds", Json::array()},
               {"paths", Json::array()}};
  for (const SceneCloud& cloud : scene.clouds) json["clouds"].push_back(json_of(cloud, box));
  for (const ScenePath& path : scene.paths) json["paths"].push_back(json_of(path, box));
  constexpr int one_line = -1;
  constexpr bool ascii_only = false;
  return json.dump(one_line, ' ', ascii_only, Json::error_handler_t::replace);
}

}  // namespace tofmap
