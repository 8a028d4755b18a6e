// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <tofmap/core/named_value.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// What a rearrangement did to a piece of furniture. Its names are `same`, `gone`, `new` and
/// `moved`.
enum class PieceState : std::uint8_t {
  same,   ///< where it was
  gone,   ///< taken away
  added,  ///< was not there before
  moved,  ///< is at another place
};

std::span<const NamedValue<PieceState>> named_values(PieceState);

/// Successive vertices and triangles of a mesh. No other triangle uses these vertices.
struct MeshPart {
  std::size_t first_vertex = 0;
  std::size_t vertices = 0;  ///< number of vertices
  std::size_t first_triangle = 0;
  std::size_t triangles = 0;  ///< number of triangles
};

/// A piece of furniture of a scene. World frame, z up, metres.
struct FurniturePiece {
  static constexpr int on_floor = -1;
  static constexpr int on_wall = -2;

  std::string name;    ///< unique in its scene
  MeshPart part = {};  ///< of the surface of the scene; without triangles if the piece is gone
  /// What carries the piece: the index of another piece in Scene::furniture, `on_floor` or
  /// `on_wall`.
  int on = on_floor;
  PieceState state = PieceState::same;
  Eigen::AlignedBox3d box = {};         ///< axis-aligned; empty if the piece is gone
  Eigen::AlignedBox3d box_before = {};  ///< before the rearrangement; empty if the piece is new
  /// How far the centre of a moved piece, with all that it carries, was moved.
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  /// Rotation of a moved piece about the vertical axis through that centre.
  double yaw_rad = 0;
};

/// The number of pieces that a rearrangement took away, added or moved. Pieces that went along with
/// what carries them do not count.
int rearranged_count(const std::vector<FurniturePiece>& furniture);

/// Writes the pieces as JSON: `pieces`, a list of objects with `name`, `state`, `on` (`floor`,
/// `wall` or the name of the piece that carries it), and the axis-aligned boxes `before` and `now`
/// with `min_m` and `max_m`, rounded to 0.1 mm. A box is null where the piece is not there. Moved
/// pieces also have `translation_m` and `yaw_deg`. Throws InputError, which names the file, if it
/// cannot be written completely.
void write_furniture(const std::filesystem::path& file,
                     const std::vector<FurniturePiece>& furniture);

}  // namespace tofmap
