// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap {
namespace {

/// A point every decimetre on floor, ceiling and walls of a box of 6 x 4 x 3 m, z up, normals
/// inwards; then turned by `map_from_box`.
MapCloud box_map(const Pose& map_from_box) {
  MapCloud map;
  const auto add = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    MapPoint out{};
    out.getVector3fMap() = (map_from_box * point).cast<float>();
    out.getNormalVector3fMap() = (map_from_box.linear() * normal).cast<float>();
    out.confidence = 1;
    out.observations = 1;
    map.push_back(out);
  };
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 40; ++j) {
      add({0.1 * i, 0.1 * j, 0}, {0, 0, 1});
      add({0.1 * i, 0.1 * j, 3}, {0, 0, -1});
    }
    for (int k = 0; k < 30; ++k) {
      add({0.1 * i, 0, 0.1 * k}, {0, 1, 0});
      add({0.1 * i, 4, 0.1 * k}, {0, -1, 0});
    }
  }
  for (int j = 0; j < 40; ++j) {
    for (int k = 0; k < 30; ++k) {
      add({0, 0.1 * j, 0.1 * k}, {1, 0, 0});
      add({6, 0.1 * j, 0.1 * k}, {-1, 0, 0});
    }
  }
  return map;
}

/// A camera in the middle of the box that looks along x and 25° down, as the map's frame.
Pose box_from_first_camera() {
  Pose box_from_camera = Pose::Identity();
  Eigen::Matrix3d axes;
  axes.col(0) = -Eigen::Vector3d::UnitY();
  axes.col(1) = -Eigen::Vector3d::UnitZ();
  axes.col(2) = Eigen::Vector3d::UnitX();
  box_from_camera.linear() =
      axes * Eigen::AngleAxisd(-0.44, Eigen::Vector3d::UnitX()).toRotationMatrix();
  box_from_camera.translation() = Eigen::Vector3d(3, 2, 1.5);
  return box_from_camera;
}

const Trajectory one_camera{{0, Pose::Identity()}};

TEST(GravityAlignedFrame, SetsATiltedMapUpright) {
  const Pose map_from_box = box_from_first_camera().inverse();
  const GravityAlignedFrame frame = gravity_aligned_frame(box_map(map_from_box), one_camera);
  const Eigen::Vector3d up = frame.aligned_from_map * map_from_box.linear().col(2);
  EXPECT_NEAR((up - Eigen::Vector3d::UnitZ()).norm(), 0, 0.02);
  EXPECT_NEAR(frame.box_m.sizes().x(), 6, 0.1) << "the longer way lies along x";
  EXPECT_NEAR(frame.box_m.sizes().y(), 4, 0.1);
  EXPECT_NEAR(frame.box_m.sizes().z(), 3, 0.1);
  EXPECT_NEAR(frame.aligned_from_map.determinant(), 1, 1e-9);
}

TEST(GravityAlignedFrame, IsNotLedAstrayByAFewStrays) {
  const Pose map_from_box = box_from_first_camera().inverse();
  MapCloud map = box_map(map_from_box);
  for (int i = 0; i < 10; ++i) {
    map.push_back(map.front());
    map.back().getVector3fMap() *= 20;
  }
  EXPECT_NEAR(gravity_aligned_frame(map, one_camera).box_m.sizes().x(), 6, 0.1);
}

TEST(GravityAlignedFrame, OfAnEmptyMapIsEmpty) {
  EXPECT_TRUE(gravity_aligned_frame({}, {}).box_m.isEmpty());
}

TEST(MapFromAbove, LooksThroughTheCeiling) {
  const MapCloud map = box_map(box_from_first_camera().inverse());
  const GravityAlignedFrame frame = gravity_aligned_frame(map, one_camera);
  const Picture picture = map_from_above(map, one_camera, frame, 600);
  const ColorScale scale(0, frame.box_m.sizes().z(), "");
  const auto like = [](Rgb a, Rgb b) {
    return std::abs(a.red - b.red) + std::abs(a.green - b.green) + std::abs(a.blue - b.blue) < 60;
  };
  const Rgb middle = picture.at(200, 200);
  EXPECT_TRUE(like(middle, scale(0))) << "the floor's colour";
  EXPECT_FALSE(like(middle, scale(3)));
}

TEST(MapPictures, OfAnEmptyMapAreDrawnAllTheSame) {
  EXPECT_GT(map_from_above({}, {}, {}, 300).width_px, 0);
  EXPECT_GT(map_from_inside({}, {}, {}, 300).width_px, 0);
}

TEST(ViewpointInside, HasTheRoomAllAround) {
  const MapCloud map = box_map(box_from_first_camera().inverse());
  const GravityAlignedFrame frame = gravity_aligned_frame(map, one_camera);
  const Drawing drawing = map_drawing(map, one_camera, frame);
  const Viewpoint viewpoint = viewpoint_inside(drawing, one_camera, frame, 1.6);
  const Picture picture = draw(drawing, viewpoint, 320, 200);
  const auto white = std::ranges::count(picture.pixels, colors::white);
  EXPECT_LT(white, 320 * 200 / 10) << "gaps between points alone";
}

/// A camera at the place that looks along x, with z up.
StampedPose level_camera(const Eigen::Vector3d& place_m) {
  StampedPose camera{0, Pose::Identity()};
  camera.world_from_camera.linear().col(0) = -Eigen::Vector3d::UnitY();
  camera.world_from_camera.linear().col(1) = -Eigen::Vector3d::UnitZ();
  camera.world_from_camera.linear().col(2) = Eigen::Vector3d::UnitX();
  camera.world_from_camera.translation() = place_m;
  return camera;
}

/// Whether a camera at the origin, with three points at `point_m` of which each has this normal, is
/// preferred to another, far away, with two points that it surely sees. The picture is 1.6 times as
/// wide as it is high.
bool sees(const Eigen::Vector3f& point_m, const Eigen::Vector3f& normal) {
  const Eigen::Vector3d far(0, 0, -500);
  PointLayer layer;
  layer.points_m.assign(3, point_m);
  layer.normals.assign(3, normal);
  layer.points_m.insert(layer.points_m.end(), 2, far.cast<float>() + 2 * Eigen::Vector3f::UnitX());
  layer.normals.insert(layer.normals.end(), 2, -Eigen::Vector3f::UnitX());
  const Trajectory cameras{level_camera(far), level_camera(Eigen::Vector3d::Zero())};
  const Drawing drawing{{layer}, {}, {}};
  return viewpoint_inside(drawing, cameras, GravityAlignedFrame(), 1.6).eye_m.z() == 0;
}

TEST(ViewpointInside, CountsPointsThatAreInViewAndFaceTheCamera) {
  // Half of the field of view is 31° upwards, whose tangent is 0.60; 0.96 sideways.
  const Eigen::Vector3f backward = -Eigen::Vector3f::UnitX();
  EXPECT_TRUE(sees({2, 0, 0}, backward));
  EXPECT_FALSE(sees({2, 0, 0}, -backward)) << "the back of a surface";
  EXPECT_FALSE(sees({-2, 0, 0}, -backward)) << "behind the camera";
  EXPECT_TRUE(sees({0.32F, 0, 0}, backward));
  EXPECT_FALSE(sees({0.28F, 0, 0}, backward)) << "too near";
  EXPECT_TRUE(sees({2, 0, 1.18F}, backward));
  EXPECT_TRUE(sees({2, 0, -1.18F}, backward));
  EXPECT_FALSE(sees({2, 0, 1.22F}, backward));
  EXPECT_FALSE(sees({2, 0, -1.22F}, backward));
  EXPECT_TRUE(sees({2, 1.9F, 0}, backward));
  EXPECT_TRUE(sees({2, -1.9F, 0}, backward));
  EXPECT_FALSE(sees({2, 1.95F, 0}, backward));
  EXPECT_FALSE(sees({2, -1.95F, 0}, backward));
}

TEST(ViewpointOutside, HoldsAllOfTheBox) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(1, 2, 0), Eigen::Vector3d(13, 11, 3));
  LineLayer diagonals;
  for (int corner = 0; corner < 8; ++corner) {
    const auto type = static_cast<Eigen::AlignedBox3d::CornerType>(corner);
    diagonals.points_m.push_back(box.center().cast<float>());
    diagonals.points_m.push_back(box.corner(type).cast<float>());
  }
  const Picture picture = draw({{}, {diagonals}, {}}, viewpoint_outside(box), 400, 250);
  for (int x = 0; x < picture.width_px; ++x) {
    EXPECT_EQ(picture.at(x, 0), colors::white);
    EXPECT_EQ(picture.at(x, 249), colors::white);
  }
  EXPECT_GT(std::ranges::count(picture.pixels, colors::black), 300);
}

TEST(MapDrawing, OfPointsWithoutNormalsHasDots) {
  MapCloud map = box_map(Pose::Identity());
  for (MapPoint& point : map) point.normal_x = point.normal_y = point.normal_z = NAN;
  const Drawing drawing = map_drawing(map, {}, gravity_aligned_frame(map, {}));
  EXPECT_EQ(drawing.points.front().points_m.size(), map.size());
  EXPECT_TRUE(drawing.points.front().normals.empty());
}

/// Pixels of a colour, but for those of its legend.
std::ptrdiff_t count_color(const Picture& picture, Rgb color) {
  return std::ranges::count(picture.pixels, color);
}

TEST(MapDrawing, TakesTheColoursOfAnyQuantity) {
  const MapCloud map = box_map(Pose::Identity());
  const GravityAlignedFrame frame = gravity_aligned_frame(map, {});
  const ColorScale scale(0, 1, "error, m", ColorRamp::error);
  const MapColoring wrong{std::vector<float>(map.size(), 2.0F), scale};
  const Drawing drawing = map_drawing(map, {}, frame, wrong);
  EXPECT_EQ(std::ranges::count(drawing.points[0].colors, scale(1)),
            static_cast<std::ptrdiff_t>(map.size()));
  EXPECT_THROW(map_drawing(map, {}, frame, {{1.0F}, scale}), UsageError);
}

TEST(PathsFromAbove, ShowsEveryPathOverTheMapAndBeyondIt) {
  const Pose box_from_camera = box_from_first_camera();
  const MapCloud map = box_map(box_from_camera.inverse());
  const auto path_to = [&](double x_m) {
    Trajectory path(2);
    path[1].timestamp_s = 1;
    const Eigen::Vector3d way(x_m, 0, 0);
    path[1].world_from_camera.translation() = box_from_camera.linear().transpose() * way;
    return path;
  };
  const GravityAlignedFrame frame = gravity_aligned_frame(map, path_to(1));
  const Rgb inside{1, 2, 200};
  const Rgb outside{200, 2, 1};
  const Picture picture = paths_from_above(
      map, {{"inside", path_to(1), inside}, {"outside", path_to(20), outside}}, frame, 600);
  EXPECT_GT(count_color(picture, inside), 20);
  EXPECT_GT(count_color(picture, outside), 1000) << "it is long, and all of it is there";
  EXPECT_GT(paths_from_above({}, {}, GravityAlignedFrame(), 600).width_px, 0) << "nothing at all";
}

}  // namespace
}  // namespace tofmap
