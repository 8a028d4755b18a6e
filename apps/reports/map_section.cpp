// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/map_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include <tofmap/core/image.hpp>
#include <tofmap/visualization/drawing.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

constexpr int map_width_px = 900;

// The palette of Okabe and Ito, as in plots. The truth is black and is drawn below the other paths.
constexpr std::array<Rgb, 4> path_colors{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}}};

bool has_errors(const ShownMap& map) { return map.errors_m && !map.errors_m->empty(); }

/// Colours a map by its errors. If they are unknown, all points get the colour of missing values.
MapColoring color_by_error(const ShownMap& map) {
  return {map.errors_m ? *map.errors_m : std::vector<float>(map.surface->size(), nan),
          ColorScale(0, far_error_m, "error, m", ColorRamp::error)};
}

/// The gravity-aligned frame of the first map. Its box is extended to the other maps, but by no
/// more than a quarter of its size to each side and not in height, so that a map that is far too
/// large does not make the first one look small.
GravityAlignedFrame frame_of(const std::vector<ShownMap>& maps) {
  GravityAlignedFrame frame =
      gravity_aligned_frame(*maps.front().surface, *maps.front().trajectory);
  if (frame.box_m.isEmpty()) return frame;
  const Eigen::Vector3d margin_m(frame.box_m.sizes().x() / 4, frame.box_m.sizes().y() / 4, 0);
  const Eigen::AlignedBox3d limit_m(frame.box_m.min() - margin_m, frame.box_m.max() + margin_m);
  for (const ShownMap& map : maps) {
    const Eigen::AlignedBox3d box_m = gravity_aligned_box(*map.surface, frame.aligned_from_map);
    if (limit_m.intersects(box_m)) frame.box_m.extend(box_m.intersection(limit_m));
  }
  return frame;
}

std::vector<PageFigure> maps_from_above(const std::vector<ShownMap>& maps,
                                        const GravityAlignedFrame& frame, bool by_error) {
  std::vector<PageFigure> figures;
  for (const ShownMap& map : maps) {
    const MapColoring coloring =
        by_error ? color_by_error(map) : color_by_height(*map.surface, frame);
    const char* meaning = !by_error      ? ", coloured by height"
                          : map.errors_m ? ", coloured by distance to the true surface"
                                         : ", errors unknown";
    figures.push_back({map_from_above(*map.surface, *map.trajectory, frame, coloring, map_width_px),
                       map.name + meaning});
  }
  return figures;
}

Trajectory moved(const Pose& target_from_source, const Trajectory& trajectory) {
  Trajectory out = trajectory;
  for (StampedPose& pose : out)
    pose.world_from_camera = target_from_source * pose.world_from_camera;
  return out;
}

/// The paths of all maps in the frame of the first map. If the truth is known, each path is first
/// aligned with it.
std::vector<NamedPath> paths_of(const std::vector<ShownMap>& maps, const Trajectory& truth) {
  std::vector<NamedPath> paths;
  const std::optional<Pose>& truth_from_first = maps.front().truth_from_map;
  if (!truth.empty() && truth_from_first) {
    paths.push_back({"truth", moved(truth_from_first->inverse(), truth), colors::black, 6});
  }
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const ShownMap& map = maps[i];
    if (i > 0 && map.trajectory == maps.front().trajectory) continue;  // the same path
    const Pose first_from_map = truth_from_first && map.truth_from_map
                                    ? truth_from_first->inverse() * *map.truth_from_map
                                    : Pose::Identity();
    paths.push_back({map.name, moved(first_from_map, *map.trajectory),
                     path_colors.at(i % path_colors.size()), 2.5F});
  }
  return paths;
}

/// A map as a cloud of the 3D view, thinned out to at most `most` points.
SceneCloud scene_cloud(const ShownMap& map, const GravityAlignedFrame& frame, bool by_error,
                       int most) {
  std::vector<MapColoring> colorings;
  if (by_error) colorings.push_back(color_by_error(map));
  colorings.push_back(color_by_height(*map.surface, frame));
  const Eigen::Matrix3f aligned_from_map = frame.aligned_from_map.cast<float>();
  const std::size_t step =
      std::max<std::size_t>(1, (map.surface->size() + most - 1) / static_cast<std::size_t>(most));
  SceneCloud cloud;
  cloud.name = map.name;
  cloud.colorings.resize(colorings.size());
  for (std::size_t i = 0; i < map.surface->size(); i += step) {
    const MapPoint& point = (*map.surface)[i];
    const Eigen::Vector3f place = aligned_from_map * point.getVector3fMap();
    if (!place.allFinite()) continue;
    const Eigen::Vector3f normal = aligned_from_map * point.getNormalVector3fMap();
    cloud.points_m.push_back(place);
    cloud.normals.push_back(normal.allFinite() ? normal : Eigen::Vector3f::Zero());
    for (std::size_t k = 0; k < colorings.size(); ++k) {
      cloud.colorings[k].push_back(colorings[k].scale(colorings[k].values[i]));
    }
  }
  return cloud;
}

/// The width of a drawn point: somewhat more than the spacing of that many points on the surface of
/// the box.
float point_size_m(const GravityAlignedFrame& frame, std::size_t points) {
  if (frame.box_m.isEmpty()) return 0.05F;
  const Eigen::Vector3d size = frame.box_m.sizes();
  const double surface_m2 = 2 * (size.x() * size.y() + size.y() * size.z() + size.x() * size.z());
  return static_cast<float>(
      std::clamp(1.3 * std::sqrt(surface_m2 / std::max<double>(1, points)), 0.02, 0.3));
}

PageScene scene_of(const std::vector<ShownMap>& maps, const GravityAlignedFrame& frame,
                   bool by_error, const std::vector<NamedPath>& paths, int most_points) {
  constexpr int legend_height_px = 220;
  PageScene scene;
  for (const ShownMap& map : maps) {
    scene.clouds.push_back(scene_cloud(map, frame, by_error, most_points));
  }
  if (by_error) {
    scene.colorings.push_back(
        {"error", color_bar(color_by_error(maps.front()).scale, legend_height_px)});
  }
  scene.colorings.push_back(
      {"height", color_bar(color_by_height({}, frame).scale, legend_height_px)});
  for (const NamedPath& path : paths) {
    ScenePath line{path.name, {}, path.color};
    for (const StampedPose& pose : path.trajectory) {
      line.points_m.push_back(
          (frame.aligned_from_map * pose.world_from_camera.translation()).cast<float>());
    }
    scene.paths.push_back(std::move(line));
  }
  scene.point_size_m = point_size_m(frame, scene.clouds.front().points_m.size());
  return scene;
}

}  // namespace

std::string name_of_map(UnwrapMethod method) {
  if (method == UnwrapMethod::none) return "without unwrapping";
  return fmt::format("with unwrapping ({})", name_of(method));
}

ShownMap shown_map(const std::string& name, const RoomMap& map, const MapScores& scores) {
  ShownMap shown{name, &map.surface, &map.trajectory, std::nullopt, std::nullopt};
  if (scores.trajectory) shown.truth_from_map = scores.trajectory->truth_from_estimate;
  if (scores.surface) shown.errors_m = scores.surface->errors_m;
  return shown;
}

void add_maps(ReportPage& page, const std::vector<ShownMap>& maps, const Trajectory& truth,
              const ReportOptions& options) {
  const ShownMap& first = maps.front();
  const GravityAlignedFrame frame = frame_of(maps);
  const bool by_error = std::ranges::any_of(maps, has_errors);
  const std::vector<NamedPath> paths = paths_of(maps, truth);
  page.add_heading("The map from above");
  add_drawn(page, [&] { return maps_from_above(maps, frame, by_error); });
  if (by_error) add_drawn(page, [&] { return maps_from_above(maps, frame, false); });
  page.add_heading("The path of the camera");
  add_drawn(page, [&] {
    return std::vector<PageFigure>{{paths_from_above(*first.surface, paths, frame, map_width_px),
                                    "paths from above, over the map " + first.name}};
  });
  page.add_heading("The map in 3D");
  page.add_text(
      "Drag to rotate, scroll to zoom, drag with the right button to pan. Surfaces are visible "
      "only from the side that the camera saw.");
  page.add_scene(scene_of(maps, frame, by_error, paths, options.points));
}

}  // namespace tofmap::app
