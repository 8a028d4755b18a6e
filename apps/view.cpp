// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "options.hpp"
#include "recording.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/acquisition/triangle_mesh.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/visualization/cloud_pictures.hpp>
#include <tofmap/visualization/map_pictures.hpp>
#include <tofmap/visualization/window.hpp>

namespace tofmap::app {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  fs::path path;
  fs::path screenshot;
  std::string from = "outside";
  std::string method;
  int frame = 0;
  int width_px = 1280;
  int height_px = 800;
  CommonArguments common;
};

/// What is to be seen, and from where.
struct View {
  Drawing drawing;
  Viewpoint viewpoint;
};

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

View view_of_map(const ViewArguments& arguments, const fs::path& map_file,
                 const fs::path& trajectory_file) {
  const MapCloud map = read_map(map_file);
  if (map.empty()) throw InputError(map_file.string() + ": holds no point; nothing to view");
  const Trajectory trajectory =
      fs::exists(trajectory_file) ? read_trajectory(trajectory_file) : Trajectory{};
  const LevelFrame frame = level_frame(map, trajectory);
  const double aspect = static_cast<double>(arguments.width_px) / arguments.height_px;
  View view{map_drawing(map, trajectory, frame), viewpoint_outside(frame.box_m)};
  if (arguments.from == "above") view.viewpoint = viewpoint_above(frame.box_m, aspect);
  if (arguments.from == "inside") {
    view.viewpoint = viewpoint_inside(view.drawing, trajectory, frame, aspect);
    view.drawing.lines.clear();
  }
  return view;
}

View view_of_mesh(const ViewArguments& arguments, const fs::path& file) {
  const TriangleMesh mesh = read_mesh(file);
  MeshLayer layer;
  layer.points_m = mesh.vertices;
  layer.triangles = mesh.triangles;
  for (const float reflectance : mesh.reflectance) {
    const auto gray = static_cast<std::uint8_t>(255 * std::clamp(reflectance, 0.0F, 1.0F));
    layer.colors.push_back({gray, gray, gray});
  }
  const Eigen::AlignedBox3d box = bounds(mesh);
  const double aspect = static_cast<double>(arguments.width_px) / arguments.height_px;
  return {{{}, {}, {std::move(layer)}},
          arguments.from == "above" ? viewpoint_above(box, aspect) : viewpoint_outside(box)};
}

/// One frame of a recording, unwrapped and filtered as the options say.
View view_of_frame(const ViewArguments& arguments, const ProgramOptions& all) {
  const PipelineOptions& options = all.pipeline;
  const SequenceReader source = open_recording(arguments.path, all.camera);
  const SourcedFrame sourced = source.read(arguments.frame);
  if (!sourced.frame) throw InputError(sourced.damage);
  const PixelRays rays = pixel_rays(source.sensor().camera);
  const RangeImage unwrapped = unwrap(*sourced.frame, source.sensor(), options.unwrap).image;
  const RangeImage kept =
      apply_filters(unwrapped, *sourced.frame, source.sensor().modulation, rays, options.filters)
          .image;
  View view;
  view.drawing = frame_drawing(kept, kept.range_m, rays);
  view.viewpoint = arguments.from == "above" ? frame_viewpoint_above(kept.range_m, rays)
                                             : frame_viewpoint_left(kept.range_m, rays);
  return view;
}

/// Whether a PLY file has faces, an OBJ file always.
bool is_mesh(const fs::path& file) {
  if (file.extension() == ".obj") return true;
  if (file.extension() != ".ply") return false;
  std::ifstream in(file, std::ios::binary);
  for (std::string line; std::getline(in, line) && line.rfind("end_header", 0) != 0;) {
    if (line.rfind("element face ", 0) == 0) return line.rfind("element face 0", 0) != 0;
  }
  return false;
}

View make_view(const ViewArguments& arguments, const ProgramOptions& options) {
  const fs::path& path = arguments.path;
  if (!fs::exists(path)) {
    throw InputError(path.string() +
                     ": not found; give a result folder of 'tofmap map', a map, "
                     "cloud or mesh (PLY, PCD, OBJ), or a recording");
  }
  if (!fs::is_directory(path)) {
    return is_mesh(path) ? view_of_mesh(arguments, path)
                         : view_of_map(arguments, path, path.parent_path() / "trajectory.txt");
  }
  if (fs::exists(path / "map.ply")) {
    return view_of_map(arguments, path / "map.ply", path / "trajectory.txt");
  }
  if (fs::exists(path / "merged.ply")) return view_of_map(arguments, path / "merged.ply", {});
  if (fs::exists(path / "sequence.yaml")) return view_of_frame(arguments, options);
  throw InputError(path.string() +
                   ": holds no map.ply, merged.ply or sequence.yaml; nothing to view");
}

void open_window(const View& view, const std::string& title) {
  try {
    Window window(title);
    window.show(view.drawing);
    window.look_from(view.viewpoint);
    window.set_text("", "left button: turn, middle: shift, wheel: zoom, q: close");
    window.run();
  } catch (const DrawingError& error) {
    throw UsageError(std::string(error.what()) + "; --screenshot FILE.png needs none");
  }
}

int run_view(const ViewArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("view", options);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);
  const View view = make_view(arguments, options);
  if (arguments.screenshot.empty()) {
    open_window(view, arguments.path.string());
    return exit_status::done;
  }
  write_picture(arguments.screenshot,
                draw(view.drawing, view.viewpoint, arguments.width_px, arguments.height_px));
  if (!arguments.common.quiet) std::printf("picture: %s\n", arguments.screenshot.c_str());
  return exit_status::done;
}

}  // namespace

void add_view_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<ViewArguments>();
  CLI::App* app = program.add_subcommand("view", "look at a map, cloud, mesh or recording");
  app->add_option("PATH", arguments->path,
                  "result folder of map, a PLY, PCD or OBJ file, or the folder of a recording")
      ->required();
  app->add_option("--screenshot", arguments->screenshot,
                  "write a PNG picture instead of opening a window; needs no display");
  app->add_option("--from", arguments->from, "viewpoint: outside, above, inside")
      ->check(CLI::IsMember({"outside", "above", "inside"}));
  app->add_option("--method", arguments->method,
                  "how to unwrap a recording: " + unwrap_method_names(", "));
  app->add_option("--frame", arguments->frame, "frame of a recording, from 0")
      ->check(CLI::Range(0, 1000000));
  app->add_option("--width", arguments->width_px, "of the picture, pixels")
      ->check(CLI::Range(16, 8000));
  app->add_option("--height", arguments->height_px, "of the picture, pixels")
      ->check(CLI::Range(16, 8000));
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_view(*arguments); });
}

}  // namespace tofmap::app
