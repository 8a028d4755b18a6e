// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/simulation/camera_path.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// A place to record, and the way through it.
struct Scene {
  std::string name;
  TriangleMesh surface = {};
  CameraPath path = {};
  int min_frames = 0;
  double max_range_m = 0;  ///< no surface is farther from a camera on the path
};

/// The built-in scenes, in the order of docs/simulator.md.
const std::vector<std::string>& scene_names();

/// A built-in scene; the seed draws the room of `random`, and means nothing to the others. Throws
/// UsageError that lists the names if there is none of that name.
Scene make_scene(const std::string& name, int seed = 1);

/// A mesh from a file, with a path that is found by ray casting: a loop at eye height through the
/// largest free space inside; if there is none (the mesh is an object), an orbit around it.
Scene make_mesh_scene(const std::filesystem::path& file);

/// A built-in scene, or a mesh where the text names a PLY or OBJ file.
Scene find_scene(const std::string& name_or_file, int seed = 1);

}  // namespace tofmap
