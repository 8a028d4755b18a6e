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

/// The gravity-aligned frame of a map: z points up, most walls are parallel to x or y, and the map
/// is longer in x than in y. To compare several maps, they are drawn in the frame of one of them.
struct GravityAlignedFrame {
  Eigen::Matrix3d aligned_from_map = Eigen::Matrix3d::Identity();
  Eigen::AlignedBox3d box_m;  ///< bounds of the map in the aligned frame, without outliers; empty
                              ///< if the map has no points
};

/// Estimates the gravity-aligned frame of a map. The vertical is the direction, within 50° of the
/// mean upward direction of the cameras, for which most surfaces are horizontal or vertical. The
/// rotation about it is chosen so that most walls are parallel to the axes. If `trajectory` is
/// empty, −y of the map takes the place of the upward direction of the cameras. Deterministic.
GravityAlignedFrame gravity_aligned_frame(const MapCloud& map, const Trajectory& trajectory);

/// The bounds of a map, without outliers, in an aligned frame that was estimated before. Empty if
/// the map has no points.
Eigen::AlignedBox3d gravity_aligned_box(const MapCloud& map,
                                        const Eigen::Matrix3d& aligned_from_map);

/// A colouring of the points of a map by a quantity.
struct MapColoring {
  std::vector<float> values;  ///< one per point
  ColorScale scale;
};

/// Colours points by their height above the bottom of the box of the frame, metres.
MapColoring color_by_height(const MapCloud& map, const GravityAlignedFrame& frame);

/// The points of a map and the path of the camera, in the aligned frame. Points with NaN
/// coordinates are left out. Throws UsageError if the colouring does not have one value per point.
Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame, const MapColoring& coloring);

/// The drawing of a map coloured by height.
Drawing map_drawing(const MapCloud& map, const Trajectory& trajectory,
                    const GravityAlignedFrame& frame);

/// The outline of a camera at a pose: a pyramid with its tip at the camera, 0.5 m long along the
/// optical axis.
LineLayer camera_outline(const Pose& aligned_from_camera);

/// A viewpoint outside a box, above one of its corners, that shows all of the box.
Viewpoint viewpoint_outside(const Eigen::AlignedBox3d& box_m);

/// The viewpoint of the camera pose, out of a few dozen on the trajectory, from which most points
/// of the map are in view with a vertical field of view of 62°. viewpoint_outside() if the
/// trajectory is empty. `drawing` is the map_drawing() of the map in `frame`; `aspect` is the width
/// of the picture divided by its height.
Viewpoint viewpoint_inside(const Drawing& drawing, const Trajectory& trajectory,
                           const GravityAlignedFrame& frame, double aspect);

/// A picture of a map from straight above in parallel projection, with the path of the camera, a
/// legend of the colours and a scale bar in metres. The longer side of the frame's box, with a
/// margin of 0.3 m, is `size_px` long. Throws DrawingError if this machine cannot draw.
Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, const MapColoring& coloring, int size_px);

/// A picture of a map from above, coloured by height.
Picture map_from_above(const MapCloud& map, const Trajectory& trajectory,
                       const GravityAlignedFrame& frame, int size_px);

/// A path to be compared with others. Its poses are in the frame of the map.
struct NamedPath {
  std::string name;
  Trajectory trajectory;
  Rgb color;
  float width_px = 3;
};

/// A picture of paths from straight above, over the map in light grey, with a legend and a scale
/// bar in metres. It shows the box of the frame and all paths. Later paths are drawn over earlier
/// ones. Throws DrawingError if this machine cannot draw.
Picture paths_from_above(const MapCloud& map, const std::vector<NamedPath>& paths,
                         const GravityAlignedFrame& frame, int size_px);

/// A picture of a map from viewpoint_inside(), coloured by height, with a legend. Throws
/// DrawingError if this machine cannot draw.
Picture map_from_inside(const MapCloud& map, const Trajectory& trajectory,
                        const GravityAlignedFrame& frame, int width_px);

}  // namespace tofmap
