// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/scenes.hpp"

#include "builtin_scenes.hpp"

#include <array>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>

namespace tofmap {
namespace {

struct NamedScene {
  const char* name;
  Scene (*make)(int seed);
};

template <Scene (*make)()>
Scene without_seed(int /*seed*/) {
  return make();
}

constexpr std::array<NamedScene, 10> builtin{{{"wall", without_seed<wall_scene>},
                                              {"slope", without_seed<slope_scene>},
                                              {"beyond", without_seed<beyond_scene>},
                                              {"corridor", without_seed<corridor_scene>},
                                              {"room", without_seed<room_scene>},
                                              {"flat", without_seed<flat_scene>},
                                              {"hall", without_seed<hall_scene>},
                                              {"atrium", without_seed<atrium_scene>},
                                              {"passage", without_seed<passage_scene>},
                                              {"random", random_scene}}};

bool is_mesh_name(const std::string& text) {
  const std::string ending = lower_extension(text);
  return ending == ".ply" || ending == ".obj";
}

}  // namespace

const std::vector<std::string>& scene_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const NamedScene& scene : builtin) all.emplace_back(scene.name);
    return all;
  }();
  return names;
}

Scene make_scene(const std::string& name, int seed) {
  for (const NamedScene& scene : builtin) {
    if (name == scene.name) return scene.make(seed);
  }
  std::string known;
  for (const std::string& other : scene_names()) known += (known.empty() ? "" : ", ") + other;
  throw UsageError("'" + name + "' is not a scene; allowed: " + known +
                   ", or a mesh file (.ply, .obj)");
}

Scene find_scene(const std::string& name_or_file, int seed) {
  return is_mesh_name(name_or_file) ? make_mesh_scene(name_or_file)
                                    : make_scene(name_or_file, seed);
}

}  // namespace tofmap
