// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/simulation/camera_path.hpp>
#include <tofmap/simulation/furniture.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// A surface to record, and a camera path through it. World frame, z up.
struct Scene {
  std::string name;
  TriangleMesh surface = {};
  CameraPath path = {};
  int min_frames = 0;      ///< smallest number of frames of a recording of the whole path
  double max_range_m = 0;  ///< rays from the path end here if the simulator has no other limit
  std::vector<FurniturePiece> furniture = {};  ///< parts of the surface that can be rearranged
};

/// Adds the triangles of `shape` to the surface of the scene as a piece of furniture, and returns
/// its index in Scene::furniture. `on` is what carries it (FurniturePiece::on). A number is
/// appended to the name if the scene has a piece of that name.
int add_piece(Scene& scene, const std::string& name, const TriangleMesh& shape,
              int on = FurniturePiece::on_floor);

/// The names of the built-in scenes.
const std::vector<std::string>& scene_names();

/// A built-in scene (docs/simulator.md). `seed` determines the room of the scene `random`, and is
/// ignored for other scenes. Throws UsageError, which lists the names, if there is no scene of that
/// name.
Scene make_scene(const std::string& name, int seed = 1);

/// A mesh from a file, with a path that is found by ray casting: a loop at eye height through the
/// largest connected free space inside the mesh, or an orbit around the mesh if it has no free
/// space inside. Throws InputError if the mesh cannot be read (read_mesh()).
Scene make_mesh_scene(const std::filesystem::path& file);

/// make_mesh_scene() if the name ends in .ply or .obj, otherwise make_scene().
Scene find_scene(const std::string& name_or_file, int seed = 1);

}  // namespace tofmap
