// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// Points with colours. With normals, points are drawn as shaded squares perpendicular to the
/// normal, visible only from the side that the normal points to, so that a room can be seen into
/// from outside. Without normals, points are drawn as dots.
struct PointLayer {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Rgb> colors;               ///< one per point
  std::vector<Eigen::Vector3f> normals;  ///< one per point, of unit length; or empty
  float size_m = 0.04F;                  ///< width of the squares
  float dot_px = 2;                      ///< width of the dots
};

/// A line through points, in their order.
struct LineLayer {
  std::vector<Eigen::Vector3f> points_m;
  Rgb color;
  float width_px = 2;
};

/// A triangle mesh, drawn with shading.
struct MeshLayer {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Rgb> colors;                              ///< one per point
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices of points
};

/// The contents of a 3D picture. All layers are in the same frame.
struct Drawing {
  std::vector<PointLayer> points;
  std::vector<LineLayer> lines;
  std::vector<MeshLayer> meshes;
};

/// The viewpoint of a 3D picture, in the frame of the drawing.
struct Viewpoint {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::UnitZ();  ///< the point in the middle of the picture
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();       ///< the direction that points up
  double vertical_fov_deg = 60;                         ///< field of view of the perspective
  /// If above 0, the projection is parallel, and the picture shows this height.
  double parallel_height_m = 0;
};

/// Thrown if this machine cannot draw, or has no display for a window.
class DrawingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws a picture without a display, by OpenGL through EGL; Mesa's software renderer is enough.
/// Must not be called by two threads at the same time. Throws DrawingError, with the packages to
/// install, if there is no renderer.
Picture draw(const Drawing& drawing, const Viewpoint& viewpoint, int width_px, int height_px);

}  // namespace tofmap
