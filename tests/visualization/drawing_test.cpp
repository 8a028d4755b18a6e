// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pixel_count.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include <tofmap/visualization/drawing.hpp>
#include <tofmap/visualization/window.hpp>

namespace tofmap {
namespace {

using test::count;
using test::red;

int count_not_white(const Picture& picture) {
  return static_cast<int>(picture.pixels.size()) - count(picture, colors::white);
}

/// Straight ahead along z, with y down, as a camera looks; the picture is 2 m high at any depth.
Viewpoint ahead() {
  Viewpoint viewpoint;
  viewpoint.parallel_height_m = 2;
  return viewpoint;
}

Drawing square_with_normal(const Eigen::Vector3f& normal) {
  PointLayer layer;
  layer.points_m = {{0, 0, 3}};
  layer.colors = {red};
  layer.normals = {normal};
  layer.size_m = 1;
  return {{layer}, {}, {}};
}

TEST(Drawing, PutsPointsWhereTheyAre) {
  PointLayer layer;
  layer.points_m = {{0.5F, -0.25F, 3}};  // right and above the middle
  layer.colors = {red};
  layer.dot_px = 5;
  const Picture picture = draw({{layer}, {}, {}}, ahead(), 200, 100);
  EXPECT_EQ(picture.width_px, 200);
  EXPECT_EQ(picture.height_px, 100);
  // 50 pixels a metre
  EXPECT_EQ(picture.at(125, 37), red);
  EXPECT_EQ(count_not_white(picture), count(picture, red));
  EXPECT_NEAR(count(picture, red), 25, 12);
}

TEST(Drawing, ShowsSquaresFromTheirFrontAlone) {
  const Picture front = draw(square_with_normal({0, 0, -1}), ahead(), 100, 100);
  EXPECT_NEAR(count_not_white(front), 50 * 50, 150) << "a square metre at 50 pixels a metre";
  EXPECT_EQ(count_not_white(draw(square_with_normal({0, 0, 1}), ahead(), 100, 100)), 0);
}

TEST(Drawing, HidesWhatIsBehind) {
  Drawing drawing = square_with_normal({0, 0, -1});
  PointLayer behind;
  behind.points_m = {{0, 0, 5}};
  behind.colors = {{0, 0, 255}};
  behind.dot_px = 9;
  drawing.points.push_back(behind);
  EXPECT_EQ(count(draw(drawing, ahead(), 100, 100), {0, 0, 255}), 0);
}

TEST(Drawing, ShowsLinesAndMeshes) {
  Drawing drawing;
  drawing.lines.push_back({{{-0.5F, 0.8F, 3}, {0.5F, 0.8F, 3}}, red, 2});
  EXPECT_GT(count(draw(drawing, ahead(), 100, 100), red), 40);
  MeshLayer mesh;
  mesh.points_m = {{-0.5F, -0.5F, 3}, {0.5F, -0.5F, 3}, {-0.5F, 0.5F, 3}};
  mesh.colors = {red, red, red};
  mesh.triangles = {{{0, 1, 2}}};
  drawing.lines.clear();
  drawing.meshes.push_back(mesh);
  EXPECT_NEAR(count_not_white(draw(drawing, ahead(), 100, 100)), 50 * 50 / 2, 100);
}

TEST(Drawing, OfNothingIsWhite) {
  EXPECT_EQ(count(draw({}, Viewpoint{}, 30, 20), colors::white), 600);
}

TEST(Drawing, IsTheSameEveryTime) {
  const Drawing drawing = square_with_normal(Eigen::Vector3f(0.3F, 0.2F, -1).normalized());
  EXPECT_EQ(draw(drawing, ahead(), 64, 48).pixels, draw(drawing, ahead(), 64, 48).pixels);
}

TEST(Window, SaysSoWhereThereIsNoDisplay) {
  unsetenv("DISPLAY");
  EXPECT_THROW(Window("a wall"), DrawingError);
}

}  // namespace
}  // namespace tofmap
