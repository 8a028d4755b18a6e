// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/furniture.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include <nlohmann/json.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Eigen::Vector3d& point_m) {
  constexpr double per_m = 1e4;
  Json list = Json::array();
  // Adding zero turns a negative zero into zero.
  for (const double value : point_m) list.push_back(std::round(value * per_m) / per_m + 0.0);
  return list;
}

Json json_of(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return nullptr;
  return {{"min_m", json_of(box.min())}, {"max_m", json_of(box.max())}};
}

std::string name_of_carrier(const FurniturePiece& piece,
                            const std::vector<FurniturePiece>& furniture) {
  if (piece.on == FurniturePiece::on_floor) return "floor";
  if (piece.on == FurniturePiece::on_wall) return "wall";
  return furniture.at(static_cast<std::size_t>(piece.on)).name;
}

Json json_of(const FurniturePiece& piece, const std::vector<FurniturePiece>& furniture) {
  Json json{{"name", piece.name},
            {"state", std::string(name_of(piece.state))},
            {"on", name_of_carrier(piece, furniture)},
            {"before", json_of(piece.box_before)},
            {"now", json_of(piece.box)}};
  if (piece.state == PieceState::moved) {
    json["translation_m"] = json_of(piece.translation_m);
    json["yaw_deg"] = std::round(piece.yaw_rad * 180 / std::numbers::pi * 100) / 100;
  }
  return json;
}

bool has_piece(const Scene& scene, const std::string& name) {
  return std::ranges::any_of(scene.furniture,
                             [&](const FurniturePiece& piece) { return piece.name == name; });
}

}  // namespace

std::span<const NamedValue<PieceState>> named_values(PieceState) {
  static constexpr NamedValue<PieceState> values[] = {{"same", PieceState::same},
                                                      {"gone", PieceState::gone},
                                                      {"new", PieceState::added},
                                                      {"moved", PieceState::moved}};
  return values;
}

int add_piece(Scene& scene, const std::string& name, const TriangleMesh& shape, int on) {
  TriangleMesh& surface = scene.surface;
  FurniturePiece piece;
  piece.name = name;
  for (int number = 2; has_piece(scene, piece.name); ++number) {
    piece.name = name + " " + std::to_string(number);
  }
  piece.part = {surface.vertices.size(), shape.vertices.size(), surface.triangles.size(),
                shape.triangles.size()};
  piece.on = on;
  piece.box = bounds(shape);
  piece.box_before = piece.box;
  add_mesh(surface, shape);
  scene.furniture.push_back(std::move(piece));
  return static_cast<int>(scene.furniture.size()) - 1;
}

int rearranged_count(const std::vector<FurniturePiece>& furniture) {
  const auto is_changed = [](const FurniturePiece& piece) {
    return piece.state != PieceState::same;
  };
  return static_cast<int>(std::ranges::count_if(furniture, [&](const FurniturePiece& piece) {
    const bool goes_along =
        piece.on >= 0 && is_changed(furniture.at(static_cast<std::size_t>(piece.on)));
    return is_changed(piece) && !goes_along;
  }));
}

void write_furniture(const std::filesystem::path& file,
                     const std::vector<FurniturePiece>& furniture) {
  Json pieces = Json::array();
  for (const FurniturePiece& piece : furniture) pieces.push_back(json_of(piece, furniture));
  const Json json{{"pieces", std::move(pieces)}};
  std::ofstream out(file);
  out << json.dump(2) << '\n';
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written");
}

}  // namespace tofmap
