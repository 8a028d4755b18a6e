// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/visualization/color.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// A map set upright: level frame with z up and walls along x and y, the longer way along x, and
/// the box that holds all of it but strays. Several maps can be drawn in the frame of one, to
/// compare them.
struct GravityAlignedFrame {
  Eigen::Matrix3d aligned_from_map = Eigen::Matrix3d::Identity();
  Eigen::AlignedBox3d box_m;  ///< level frame; empty if there is no point
};

/// Finds the vertical, near the cameras' own upward direction, to which most surfaces are level or
/// upright; then turns the walls along the axes. `trajectory` may be empty: then the cameras'
/// upward direction is −y of the map. Deterministic.
GravityAlignedFrame gravity_aligned_frame(const MapCloud& map, const Trajectory& trajectory);

/// The box of a level frame that was found before, of a map that has grown since.
Eigen::AlignedBox3d gravity_aligned_box(const MapCloud& map,
                                        const Eigen::Matrix3d& aligned_from_map);

/// What the points of a map are coloured by: a value each, and its scale.
struct MapColoring {
  std::vector<float> values;
  ColorScale scale;
};

/// By height above the lowest surface of the frame's box.
MapColoring color_by_height(const MapCloud& map, const GravityAlignedFrame& frame);

/// The map in its level frame, and the camera's path. Points without a place are left out. Throws
/// UsageError if there are not as many values as points.
Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame, const MapColoring& coloring);

/// The same, coloured by height.
Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame);

/// The pyramid that a camera sees, as far as half a metre.
LineLayer camera_outline(const Pose& aligned_from_camera);

/// From outside and above a corner, so that all of the box is in the picture.
Viewpoint viewpoint_outside(const Eigen::AlignedBox3d& box_m);

/// From the place on the camera's path that shows the most of the map, wider than the camera saw;
/// from outside if there is no path. `drawing` is the map's; `aspect` is width over height.
Viewpoint viewpoint_inside(const Drawing& drawing, const Trajectory& trajectory,
                           const GravityAlignedFrame& frame, double aspect);

/// The map from straight above, in parallel projection, with the camera's path, a legend of
/// its colours, and a scale in metres. The longer side of the frame's box is `size_px` long.
Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, const MapColoring& coloring, int size_px);

/// The same, coloured by height.
Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, int size_px);

/// A path to be compared with others; poses in the frame of the map.
struct NamedPath {
  std::string name;
  Trajectory trajectory;
  Rgb color;
  float width_px = 3;
};

/// Paths from straight above, over the map in light grey, with a legend and a scale in metres. The
/// box of the frame, and all paths, are within. The first is drawn undermost.
Picture paths_from_above(const MapCloud& map, const std::vector<NamedPath>& paths,
                         const GravityAlignedFrame& frame, int size_px);

/// The map as seen from inside, with a legend of height.
Picture map_from_inside(const MapCloud& map, const Trajectory& trajectory,
                        const GravityAlignedFrame& frame, int width_px);

}  // namespace tofmap
