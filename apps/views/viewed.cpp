// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "views/viewed.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <tofmap/core/error.hpp>
#include <tofmap/core/input_file.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_store.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

/// A view from the centre of a box along its longer horizontal side.
Viewpoint viewpoint_in_the_middle(const Eigen::AlignedBox3d& box_m) {
  Viewpoint viewpoint;
  if (box_m.isEmpty()) return viewpoint;
  const bool is_wide = box_m.sizes().x() > box_m.sizes().y();
  viewpoint.up = Eigen::Vector3d::UnitZ();
  viewpoint.eye_m = box_m.center();
  viewpoint.target_m =
      viewpoint.eye_m + (is_wide ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY());
  return viewpoint;
}

/// A mesh file, in the grey of its reflectance.
class ViewedMesh final : public Viewed {
 public:
  explicit ViewedMesh(const fs::path& file) : Viewed(color_names::mesh), mesh_(read_mesh(file)) {}

  Drawing drawing() const override {
    MeshLayer layer;
    layer.points_m = mesh_.vertices;
    layer.triangles = mesh_.triangles;
    for (const float reflectance : mesh_.reflectance) {
      const auto gray = static_cast<std::uint8_t>(
          255 * std::clamp(std::isnan(reflectance) ? 0 : reflectance, 0.0F, 1.0F));
      layer.colors.push_back({gray, gray, gray});
    }
    return {{}, {}, {std::move(layer)}};
  }

  Viewpoint viewpoint(const std::string& from, double aspect) const override {
    const Eigen::AlignedBox3d box_m = bounds(mesh_);
    if (from == "above") return viewpoint_above(box_m, aspect);
    return from == "inside" ? viewpoint_in_the_middle(box_m) : viewpoint_outside(box_m);
  }

  Picture legend() const override { return {}; }

  std::string status() const override { return counted(mesh_.triangles.size(), "triangle"); }

 private:
  TriangleMesh mesh_;
};

/// Whether a file is a mesh: an OBJ file, or a PLY file with faces.
bool is_mesh(const fs::path& file) {
  if (lower_extension(file) == ".obj") return true;
  if (lower_extension(file) != ".ply") return false;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line) && line.rfind("end_header", 0) != 0;) {
    if (line.rfind("element face ", 0) == 0) return line.rfind("element face 0", 0) != 0;
  }
  return false;
}

/// Throws UsageError if the request has arguments that only apply to recordings.
void refuse_what_is_of_recordings(const ViewRequest& request) {
  const std::string asked = request.frame ? "--frame" : request.wrapped ? "--wrapped" : "";
  if (!asked.empty()) {
    throw UsageError(asked + " is for recordings, and " + request.path.string() + " is not one");
  }
}

std::unique_ptr<Viewed> view_map_or_mesh(const ViewRequest& request, const fs::path& file) {
  refuse_what_is_of_recordings(request);
  if (!request.method.empty()) {
    throw UsageError("--method is for recordings and evaluations, and " + request.path.string() +
                     " is neither");
  }
  if (!fs::is_directory(request.path) && is_mesh(file)) return std::make_unique<ViewedMesh>(file);
  return view_maps({{file, ""}}, request);
}

/// The maps of the methods in the result folder of an evaluation, the most accurate method first.
/// Empty if there are none.
std::vector<ViewedFile> maps_of_methods(const fs::path& folder) {
  std::vector<ViewedFile> files;
  for (const auto& [method, value] : named_values(UnwrapMethod{})) {
    const fs::path file = folder / method / "map.ply";
    if (fs::exists(file)) files.push_back({file, std::string(method)});
  }
  return files;
}

/// Opens the maps of an evaluation, beginning with the requested method.
std::unique_ptr<Viewed> view_evaluation(const ViewRequest& request, std::vector<ViewedFile> files) {
  refuse_what_is_of_recordings(request);
  if (!request.method.empty()) {
    const auto first = std::ranges::find(files, request.method, &ViewedFile::method);
    if (first == files.end()) {
      std::vector<std::string> methods;
      for (const ViewedFile& file : files) methods.push_back(file.method);
      throw UsageError("--method " + request.method + ": " + request.path.string() +
                       " holds the maps of " + joined(methods, ", "));
    }
    std::rotate(files.begin(), first, files.end());
  }
  return view_maps(files, request);
}

}  // namespace

Viewpoint viewpoint_above(const Eigen::AlignedBox3d& box_m, double aspect) {
  Viewpoint viewpoint;
  viewpoint.up = Eigen::Vector3d::UnitY();
  if (box_m.isEmpty()) return viewpoint;
  const Eigen::Vector3d size = box_m.sizes();
  viewpoint.target_m = box_m.center();
  viewpoint.eye_m = viewpoint.target_m + 2 * (size.z() + 1) * Eigen::Vector3d::UnitZ();
  viewpoint.parallel_height_m = 1.05 * std::max({size.y(), size.x() / aspect, 0.1});
  return viewpoint;
}

void Viewed::color_by(const std::string& name) {
  const auto found = std::ranges::find(color_names_, name);
  if (found == color_names_.end()) {
    throw UsageError("--color " + name + ": allowed here: " + joined(color_names_, ", "));
  }
  color_ = static_cast<std::size_t>(found - color_names_.begin());
}

void Viewed::color_by_next() { color_ = (color_ + 1) % color_names_.size(); }

std::unique_ptr<Viewed> open_viewed(const ViewRequest& request, const ProgramOptions& options) {
  const fs::path& path = request.path;
  if (!fs::exists(path)) {
    throw InputError(path.string() +
                     ": not found; name the result folder of a command, a map, cloud or mesh (PLY, "
                     "PCD, OBJ), or a recording");
  }
  if (!fs::is_directory(path)) return view_map_or_mesh(request, path);
  for (const char* name : {"map.ply", "merged.ply"}) {
    if (fs::exists(path / name)) return view_map_or_mesh(request, path / name);
  }
  if (fs::exists(path / "sequence.yaml")) {
    if (request.cameras) {
      throw UsageError("--cameras is for maps, and " + path.string() + " is a recording");
    }
    if (request.keyframe) {
      throw UsageError("--keyframe is for maps, and " + path.string() + " is a recording");
    }
    return view_recording(request, options);
  }
  if (const auto files = maps_of_methods(path); !files.empty()) {
    return view_evaluation(request, files);
  }
  if (fs::exists(path / map_file_name)) return view_map_or_mesh(request, path / map_file_name);
  throw InputError(
      path.string() +
      ": contains no map.ply, merged.ply, map.db, sequence.yaml or METHOD/map.ply; nothing to "
      "view");
}

}  // namespace tofmap::app
