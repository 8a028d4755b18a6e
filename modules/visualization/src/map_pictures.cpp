// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/map_pictures.hpp"

#include "picture_gap.hpp"
#include "text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

ColorScale height_scale(const GravityAlignedFrame& frame) {
  const double height_m = frame.box_m.isEmpty() ? 0 : frame.box_m.sizes().z();
  return {0, std::max(0.1, height_m), "height, m"};
}

/// The spacing of the points of a map, metres: the lower quartile of the distances between
/// successive points, which are often neighbours in the voxel grid.
float typical_spacing_m(const MapCloud& map) {
  std::vector<float> steps;
  for (std::size_t i = 1; i < map.size(); ++i) {
    steps.push_back((map[i].getVector3fMap() - map[i - 1].getVector3fMap()).norm());
  }
  if (steps.empty()) return 0.04F;
  const auto place = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::nth_element(steps.begin(), place, steps.end());
  return std::clamp(*place, 0.005F, 0.2F);
}

/// A picture with a scale bar of a round length below it.
Picture with_scale_bar(const Picture& picture, double metres_per_px) {
  double length_m = 1;
  for (const double round : {2.0, 5.0, 10.0, 20.0}) {
    if (round < 0.3 * picture.width_px * metres_per_px) length_m = round;
  }
  const int length_px = static_cast<int>(std::lround(length_m / metres_per_px));
  const Picture label = text_picture(short_number(length_m) + " m", text_size_px);
  Picture bar(std::max(length_px, label.width_px), text_size_px);
  fill(bar, 0, text_size_px / 2 - 2, length_px, 4, colors::black);
  fill(bar, 0, 2, 2, text_size_px - 4, colors::black);
  fill(bar, length_px - 2, 2, 2, text_size_px - 4, colors::black);
  return stacked({picture, beside({bar, label}, picture_gap_px / 2)}, picture_gap_px / 2);
}

LineLayer path_line(const Trajectory& trajectory, const GravityAlignedFrame& frame, Rgb color,
                    float width_px) {
  LineLayer line{{}, color, width_px};
  for (const StampedPose& pose : trajectory) {
    line.points_m.push_back(
        (frame.aligned_from_map * pose.world_from_camera.translation()).cast<float>());
  }
  return line;
}

/// A picture of a drawing from straight above, in parallel projection, with a scale bar.
Picture drawn_from_above(const Drawing& drawing, const Eigen::AlignedBox3d& box_m, int size_px) {
  constexpr double margin_m = 0.3;
  const Eigen::Vector3d size = box_m.sizes().array() + 2 * margin_m;
  const double metres_per_px = std::max(size.x(), size.y()) / size_px;
  const int width_px = static_cast<int>(std::ceil(size.x() / metres_per_px));
  const int height_px = static_cast<int>(std::ceil(size.y() / metres_per_px));
  Viewpoint viewpoint;
  viewpoint.target_m = box_m.center();
  viewpoint.eye_m = viewpoint.target_m + 2 * size.z() * Eigen::Vector3d::UnitZ();
  viewpoint.up = Eigen::Vector3d::UnitY();
  viewpoint.parallel_height_m = height_px * metres_per_px;
  return with_scale_bar(draw(drawing, viewpoint, width_px, height_px), metres_per_px);
}

Viewpoint viewpoint_of(const Pose& aligned_from_camera, double vertical_fov_deg) {
  Viewpoint viewpoint;
  viewpoint.eye_m = aligned_from_camera.translation();
  viewpoint.target_m = aligned_from_camera * Eigen::Vector3d::UnitZ();
  viewpoint.up = Eigen::Vector3d::UnitZ();
  viewpoint.vertical_fov_deg = vertical_fov_deg;
  return viewpoint;
}

/// The number of points in the view of a camera whose normals face it. Points behind walls are
/// counted as well.
int count_seen(const PointLayer& layer, const Pose& aligned_from_camera, double tangent_x,
               double tangent_y) {
  const Eigen::Isometry3f camera_from_aligned = aligned_from_camera.inverse().cast<float>();
  const Eigen::Vector3f eye = aligned_from_camera.translation().cast<float>();
  int seen = 0;
  for (std::size_t i = 0; i < layer.points_m.size(); ++i) {
    const Eigen::Vector3f p = camera_from_aligned * layer.points_m[i];
    const bool in_view =
        p.z() > 0.3F && std::abs(p.x()) < tangent_x * p.z() && std::abs(p.y()) < tangent_y * p.z();
    const bool faces = layer.normals.empty() || layer.normals[i].dot(eye - layer.points_m[i]) > 0;
    seen += in_view && faces ? 1 : 0;
  }
  return seen;
}

}  // namespace

MapColoring color_by_height(const MapCloud& map, const GravityAlignedFrame& frame) {
  const Eigen::Vector3f up = frame.aligned_from_map.row(2).transpose().cast<float>();
  const float floor_m = frame.box_m.isEmpty() ? 0 : static_cast<float>(frame.box_m.min().z());
  MapColoring coloring{{}, height_scale(frame)};
  coloring.values.reserve(map.size());
  for (const MapPoint& point : map) {
    coloring.values.push_back(up.dot(point.getVector3fMap()) - floor_m);
  }
  return coloring;
}

Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame, const MapColoring& coloring) {
  if (coloring.values.size() != map.size()) {
    throw UsageError("map colours: the number of values differs from the number of points");
  }
  const Eigen::Matrix3f aligned_from_map = frame.aligned_from_map.cast<float>();
  PointLayer layer;
  layer.size_m = 1.6F * typical_spacing_m(map);  // squares overlap, so that there are no gaps
  const bool has_normals =
      std::ranges::all_of(map, [](const MapPoint& point) { return std::isfinite(point.normal_z); });
  for (std::size_t i = 0; i < map.size(); ++i) {
    const MapPoint& point = map[i];
    const Eigen::Vector3f p = aligned_from_map * point.getVector3fMap();
    if (!p.allFinite()) continue;
    layer.points_m.push_back(p);
    layer.colors.push_back(coloring.scale(coloring.values[i]));
    if (has_normals) layer.normals.push_back(aligned_from_map * point.getNormalVector3fMap());
  }
  return {{std::move(layer)}, {path_line(trajectory, frame, colors::path, 2.5F)}, {}};
}

Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame) {
  return map_drawing(map, trajectory, frame, color_by_height(map, frame));
}

LineLayer camera_outline(const Pose& aligned_from_camera) {
  LineLayer outline{{}, colors::path, 2.5F};
  const auto go_to = [&](double x_m, double y_m, double z_m) {
    outline.points_m.push_back(
        (aligned_from_camera * Eigen::Vector3d(x_m, y_m, z_m)).cast<float>());
  };
  // One line: after each side of the base, it goes to the tip and back.
  for (const auto& [x_m, y_m] :
       {std::pair(-0.25, -0.2), std::pair(0.25, -0.2), std::pair(0.25, 0.2), std::pair(-0.25, 0.2),
        std::pair(-0.25, -0.2)}) {
    go_to(x_m, y_m, 0.5);
    go_to(0, 0, 0);
    go_to(x_m, y_m, 0.5);
  }
  return outline;
}

Viewpoint viewpoint_outside(const Eigen::AlignedBox3d& box_m) {
  Viewpoint viewpoint;
  viewpoint.vertical_fov_deg = 40;
  viewpoint.up = Eigen::Vector3d::UnitZ();
  if (box_m.isEmpty()) return viewpoint;
  const Eigen::Vector3d backward = Eigen::Vector3d(-0.45, -0.62, 0.64).normalized();
  const Eigen::Vector3d right = viewpoint.up.cross(backward).normalized();
  const Eigen::Vector3d upward = backward.cross(right);
  // The distance from which all corners are inside the picture, with a margin of 5 %.
  constexpr double narrowest_aspect = 1.2;
  const double tangent = std::tan(viewpoint.vertical_fov_deg / 2 * std::numbers::pi / 180);
  double distance_m = 0.1;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    const Eigen::Vector3d offset = box_m.corner(type) - box_m.center();
    const double extent =
        std::max(std::abs(offset.dot(upward)), std::abs(offset.dot(right)) / narrowest_aspect);
    distance_m = std::max(distance_m, offset.dot(backward) + 1.05 * extent / tangent);
  }
  viewpoint.target_m = box_m.center();
  viewpoint.eye_m = viewpoint.target_m + distance_m * backward;
  return viewpoint;
}

Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, const MapColoring& coloring, int size_px) {
  if (frame.box_m.isEmpty()) return titled(Picture(size_px, size_px / 2), "the map is empty");
  const Picture picture =
      drawn_from_above(map_drawing(map, trajectory, frame, coloring), frame.box_m, size_px);
  const Picture legend = stacked({color_bar(coloring.scale, std::min(picture.height_px, 400)),
                                  color_key({{colors::path, "camera"}})},
                                 picture_gap_px);
  return with_margin(beside({picture, legend}, picture_gap_px), picture_gap_px);
}

Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, int size_px) {
  return map_from_above(map, trajectory, frame, color_by_height(map, frame), size_px);
}

Picture paths_from_above(const MapCloud& map, const std::vector<NamedPath>& paths,
                         const GravityAlignedFrame& frame, int size_px) {
  Drawing drawing = map_drawing(map, {}, frame);
  for (PointLayer& layer : drawing.points) std::ranges::fill(layer.colors, Rgb{225, 228, 232});
  Eigen::AlignedBox3d box_m = frame.box_m;
  std::vector<LegendEntry> entries;
  drawing.lines.clear();
  for (const NamedPath& path : paths) {
    drawing.lines.push_back(path_line(path.trajectory, frame, path.color, path.width_px));
    for (Eigen::Vector3f& point : drawing.lines.back().points_m) {
      // Raises the path above the map and the paths before it.
      point.z() = static_cast<float>(frame.box_m.isEmpty() ? 0 : frame.box_m.max().z()) +
                  0.02F * static_cast<float>(drawing.lines.size());
      box_m.extend(point.cast<double>());
    }
    entries.push_back({path.color, path.name});
  }
  if (box_m.isEmpty()) return titled(Picture(size_px, size_px / 2), "there is no path");
  return with_margin(
      beside({drawn_from_above(drawing, box_m, size_px), color_key(entries)}, picture_gap_px),
      picture_gap_px);
}

Viewpoint viewpoint_inside(const Drawing& drawing, const Trajectory& trajectory,
                           const GravityAlignedFrame& frame, double aspect) {
  if (trajectory.empty()) return viewpoint_outside(frame.box_m);
  constexpr double vertical_fov_deg = 62;
  const double tangent_y = std::tan(vertical_fov_deg / 2 * std::numbers::pi / 180);
  constexpr std::size_t candidates = 24;
  const std::size_t step = std::max<std::size_t>(1, trajectory.size() / candidates);
  Pose best = Pose::Identity();
  int most = -1;
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    const Pose pose = Pose(frame.aligned_from_map) * trajectory[i].world_from_camera;
    const int seen = count_seen(drawing.points.front(), pose, aspect * tangent_y, tangent_y);
    if (seen > most) {
      most = seen;
      best = pose;
    }
  }
  return viewpoint_of(best, vertical_fov_deg);
}

Picture map_from_inside(const MapCloud& map, const Trajectory& trajectory,
                        const GravityAlignedFrame& frame, int width_px) {
  constexpr double aspect = 1.6;
  const int height_px = static_cast<int>(width_px / aspect);
  if (frame.box_m.isEmpty()) return titled(Picture(width_px, height_px), "the map is empty");
  Drawing drawing = map_drawing(map, trajectory, frame);
  drawing.lines.clear();
  const Viewpoint viewpoint = viewpoint_inside(drawing, trajectory, frame, aspect);
  const Picture picture = draw(drawing, viewpoint, width_px, height_px);
  return with_margin(beside({picture, color_bar(height_scale(frame), 400)}, picture_gap_px),
                     picture_gap_px);
}

}  // namespace tofmap
