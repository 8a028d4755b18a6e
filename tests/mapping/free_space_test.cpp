// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/free_space.hpp>
#include <tofmap/mapping/moving_regions.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;
using test::moved_by;
using test::small_camera;

constexpr double margin_m = 0.04;

/// Keyframes that look at the far wall of a box, z = 3.5, from slightly different places.
class SeenThrough : public testing::Test {
 protected:
  SeenThrough() {
    for (int i = 0; i < 3; ++i) {
      const Pose pose = moved_by({0, 0.05 * i, 0}, {0.1 * i, 0, 0});
      keyframes_.push_back({.id = i,
                            .world_from_camera = pose,
                            .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                                small_camera(), {-1.5, -1, -2.5}, {2, 1.2, 3.5}, pose))});
    }
  }

  bool keeps(const Vector3d& point_m) const {
    MapPoint point{};
    point.getVector3fMap() = point_m.cast<float>();
    point.normal_z = -1;
    MapCloud map;
    map.push_back(point);
    return !without_free_space_violations(map, keyframes_, small_camera(), margin_m).empty();
  }

  /// Calls `change` with column, row and point of all pixels of all keyframes.
  template <class Change>
  void change_points(const Change& change) {
    for (Keyframe& keyframe : keyframes_) {
      SurfaceCloud cloud = *keyframe.cloud.load();
      for (int row = 0; row < static_cast<int>(cloud.height); ++row) {
        for (int col = 0; col < static_cast<int>(cloud.width); ++col) {
          change(col, row, cloud.at(col, row));
        }
      }
      keyframe.cloud = std::make_shared<const SurfaceCloud>(cloud);
    }
  }

  std::vector<Keyframe> keyframes_;
};

TEST_F(SeenThrough, DropsWhatStandsBeforeTheSurface) {
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
  EXPECT_FALSE(keeps({0.1, 0.1, 3.3}));
}

TEST_F(SeenThrough, KeepsTheSurfaceAndWhatIsWithinTheMargin) {
  EXPECT_TRUE(keeps({0.1, 0.1, 3.5}));
  EXPECT_TRUE(keeps({0.1, 0.1, 3.47}));
}

TEST_F(SeenThrough, KeepsWhatIsHiddenOrOutOfView) {
  EXPECT_TRUE(keeps({0.1, 0.1, 4}));
  EXPECT_TRUE(keeps({0.1, 0.1, -2}));
  EXPECT_TRUE(keeps({100, 0, 2}));
}

TEST_F(SeenThrough, DropsByOneKeyframeWhatNoneAgreesWith) {
  keyframes_.resize(1);
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
  // One that agrees takes two that do not.
  keyframes_.push_back({.id = 1,
                        .world_from_camera = Pose::Identity(),
                        .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                            small_camera(), {-9, -9, -9}, {9, 9, 2}, Pose::Identity()))});
  EXPECT_TRUE(keeps({0.1, 0.1, 2}));
}

TEST_F(SeenThrough, LetsKeyframesThatAgreeOutvoteOthers) {
  // An object at 2 m that three keyframes see, and that two others saw before it came.
  for (int i = 3; i < 6; ++i) {
    keyframes_.push_back({.id = i,
                          .world_from_camera = Pose::Identity(),
                          .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                              small_camera(), {-9, -9, -9}, {9, 9, 2}, Pose::Identity()))});
  }
  EXPECT_TRUE(keeps({0.1, 0.1, 2}));
  keyframes_.resize(5);
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
}

TEST_F(SeenThrough, DropsWhatThreeKeyframesSeeThroughAtLast) {
  // An object at 2 m that four keyframes see before it goes.
  const Keyframe seeing{.id = 0,
                        .world_from_camera = Pose::Identity(),
                        .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                            small_camera(), {-9, -9, -9}, {9, 9, 2}, Pose::Identity()))};
  keyframes_.insert(keyframes_.begin(), 4, seeing);
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
  std::ranges::reverse(keyframes_);
  EXPECT_TRUE(keeps({0.1, 0.1, 2})) << "it has come";
  std::ranges::reverse(keyframes_);
  keyframes_.pop_back();
  EXPECT_TRUE(keeps({0.1, 0.1, 2})) << "two may be deceived";
}

TEST_F(SeenThrough, SaysNothingWhereAKeyframeHasNoRange) {
  change_points([](int, int, SurfacePoint& point) { point.z = point.normal_z = NAN; });
  EXPECT_TRUE(keeps({0.1, 0.1, 2}));
}

TEST_F(SeenThrough, KnowsFreeSpaceByRangesWithoutNormalsButNoSurface) {
  change_points([](int, int, SurfacePoint& point) { point.normal_z = NAN; });
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
  // Three keyframes that agreed would outvote the two that see through.
  const auto seeing = std::make_shared<const SurfaceCloud>(
      test::box_cloud(small_camera(), {-9, -9, -9}, {9, 9, 2}, Pose::Identity()));
  keyframes_.resize(2);
  for (int i = 2; i < 5; ++i) {
    keyframes_.push_back({.id = i, .world_from_camera = Pose::Identity(), .cloud = seeing});
  }
  std::ranges::reverse(keyframes_);
  EXPECT_TRUE(keeps({0.1, 0.1, 2}));
  change_points([](int, int, SurfacePoint& point) { point.normal_z = NAN; });
  EXPECT_FALSE(keeps({0.1, 0.1, 2}));
}

TEST_F(SeenThrough, NeedsSixOfNinePixelsWithRanges) {
  keyframes_.resize(1);
  // The point projects to the pixel (col, row) of the keyframe at the origin.
  const Vector3d point_m(0.1, 0.1, 2);
  const std::optional<Eigen::Vector2d> pixel = project(small_camera(), point_m);
  const int col = static_cast<int>(std::round(pixel->x()));
  const int row = static_cast<int>(std::round(pixel->y()));
  const auto remove = [](SurfacePoint& point) { point.z = point.normal_z = NAN; };
  change_points([&](int c, int, SurfacePoint& point) {
    if (c == col + 1) remove(point);
  });
  EXPECT_FALSE(keeps(point_m)) << "six";
  change_points([&](int c, int r, SurfacePoint& point) {
    if (c == col - 1 && r == row) remove(point);
  });
  EXPECT_TRUE(keeps(point_m)) << "five";
}

TEST_F(SeenThrough, KeepsWhatOnePixelSeesAtItsRangeWithoutANormal) {
  // A thin post before a wall: its pixels have ranges, but no planes.
  keyframes_.resize(1);
  const Vector3d point_m(0.1, 0.1, 2);
  const std::optional<Eigen::Vector2d> pixel = project(small_camera(), point_m);
  const int col = static_cast<int>(std::round(pixel->x()));
  change_points([&](int c, int, SurfacePoint& point) {
    if (c != col + 1) return;
    point.getVector3fMap() *= 2 / point.z;
    point.normal_z = NAN;
  });
  EXPECT_TRUE(keeps(point_m));
}

TEST_F(SeenThrough, DistrustsRangesWithoutNormalsWhoseWrapCountsAreUncertain) {
  change_points([](int, int, SurfacePoint& point) {
    point.normal_z = NAN;
    point.confidence = 0.8F;
  });
  EXPECT_TRUE(keeps({0.1, 0.1, 2}));
  change_points([](int, int, SurfacePoint& point) { point.confidence = moving_confidence; });
  EXPECT_FALSE(keeps({0.1, 0.1, 2})) << "something that moves";
}

TEST_F(SeenThrough, IsNoneBetweenKeyframesOfOneRoomAndMuchWhereOneIsMisplaced) {
  const auto share = [&](const Pose& placed) {
    return free_space_violation_share(
        {keyframes_[2].cloud.load().get(), placed},
        {keyframes_[0].cloud.load().get(), keyframes_[0].world_from_camera}, small_camera(),
        margin_m);
  };
  const Pose right = keyframes_[2].world_from_camera;
  EXPECT_LT(share(right), 0.01);
  // Its far wall stands half a metre in front of the one that the other keyframe sees.
  EXPECT_GT(share(moved_by({0, 0, 0}, {0, 0, -0.5}) * right), 0.3);
  EXPECT_EQ(share(moved_by({0, 0, 0}, {0, 0, 50}) * right), 0) << "they see nothing in common";
}

}  // namespace
}  // namespace tofmap
