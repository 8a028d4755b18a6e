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

/// Points, one colour each. With normals (one each) they are small lit squares in their surface,
/// `size_m` wide, which cannot be seen from behind: from outside one looks into a room. Without,
/// they are dots of `dot_px`.
struct PointLayer {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Rgb> colors;
  std::vector<Eigen::Vector3f> normals;
  float size_m = 0.04F;
  float dot_px = 2;
};

struct LineLayer {
  std::vector<Eigen::Vector3f> points_m;  ///< one line through all of them
  Rgb color;
  float width_px = 2;
};

/// Triangles, lit, with one colour a vertex.
struct MeshLayer {
  std::vector<Eigen::Vector3f> points_m;
  std::vector<Rgb> colors;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What is to be drawn in three dimensions; all layers in one frame.
struct Drawing {
  std::vector<PointLayer> points;
  std::vector<LineLayer> lines;
  std::vector<MeshLayer> meshes;
};

/// From where. With a parallel height the projection is parallel, and the picture that many metres
/// high; else it is a perspective with a vertical field of view.
struct Viewpoint {
  Eigen::Vector3d eye_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d target_m = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  double vertical_fov_deg = 60;
  double parallel_height_m = 0;
};

/// There is no way to draw on this machine; the message names the remedy.
class DrawingError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Draws off screen; needs no display, only Mesa's software renderer (EGL). Use it from one
/// thread at a time. Throws DrawingError if there is no renderer.
Picture draw(const Drawing& drawing, const Viewpoint& viewpoint, int width_px, int height_px);

}  // namespace tofmap
