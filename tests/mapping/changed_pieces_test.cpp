// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "changed_pieces.hpp"

#include "support/box_room.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Eigen::Vector3d;
using test::moved_by;
using test::small_camera;

/// A surface in the middle of a box, through which later keyframes see the far wall, z = 3.5.
class SurfaceInFreeSpace : public testing::Test {
 protected:
  static constexpr double step_m = 0.04;  // the voxels of the map

  SurfaceInFreeSpace() { add_keyframes(3, 3.5); }

  /// Adds later keyframes that see a wall.
  void add_keyframes(int count, double wall_m) {
    for (int i = 0; i < count; ++i) {
      const Pose pose = moved_by({0, 0.05 * i, 0}, {0.1 * i, 0, 0});
      later_.keyframes.push_back({.id = static_cast<int>(later_.keyframes.size()),
                                  .world_from_camera = pose,
                                  .cloud = std::make_shared<const SurfaceCloud>(test::box_cloud(
                                      small_camera(), {-1.5, -1, -2.5}, {2, 1.2, wall_m}, pose))});
    }
  }

  /// Adds a square of `side` x `side` points that faces the cameras.
  void add_square(const Vector3d& corner_m, int side, std::uint32_t observations,
                  Certainty certainty, double gap_m = step_m) {
    for (int i = 0; i < side * side; ++i) {
      MapPoint point{};
      point.getVector3fMap() =
          (corner_m + gap_m * Vector3d(i % side, static_cast<double>(i / side), 0)).cast<float>();
      point.normal_z = -1;
      point.observations = observations;
      seen_.points.push_back(point);
      seen_.certainty.push_back(certainty);
    }
  }

  /// The numbers of points of the pieces that are gone.
  std::vector<std::size_t> gone() const {
    std::vector<std::size_t> sizes;
    for (const MapCloud& piece : pieces_violating_free_space(seen_, later_, content_)) {
      sizes.push_back(piece.size());
    }
    return sizes;
  }

  MapContent content_{small_camera(), SurfaceMapOptions()};
  SeenSurface seen_;
  SeenSurface later_;
};

TEST_F(SurfaceInFreeSpace, IsGone) {
  add_square({0, 0, 2}, 10, 50, Certainty::sure);
  EXPECT_EQ(gone(), std::vector<std::size_t>{100});
}

TEST_F(SurfaceInFreeSpace, IsNotGoneIfNoKeyframeWasSureOfIt) {
  add_square({0, 0, 2}, 10, 50, Certainty::possible);
  EXPECT_TRUE(gone().empty());
}

TEST_F(SurfaceInFreeSpace, IsNotGoneIfSomeKeyframesStillSeeIt) {
  add_square({0, 0, 2}, 10, 50, Certainty::sure);
  add_keyframes(2, 2);
  EXPECT_TRUE(gone().empty());
}

TEST_F(SurfaceInFreeSpace, TakesAlongWhatIsPossibleBesideIt) {
  add_square({0, 0, 2}, 10, 50, Certainty::sure);
  add_square({10 * step_m, 0, 2}, 10, 50, Certainty::possible);
  EXPECT_EQ(gone(), std::vector<std::size_t>{200});
}

TEST_F(SurfaceInFreeSpace, IsGoneEvenIfItWasRarelyObserved) {
  add_square({0, 0, 2}, 10, 3, Certainty::sure);
  // Without its corners, where fewer points lie side by side.
  ASSERT_EQ(gone().size(), 1U);
  EXPECT_GT(gone()[0], 80U);
}

TEST_F(SurfaceInFreeSpace, IsNoneIfItsPointsWereRarelyObservedAndLieScattered) {
  add_square({0, 0, 2}, 8, 3, Certainty::sure, 3 * step_m);
  EXPECT_TRUE(gone().empty());
}

TEST_F(SurfaceInFreeSpace, MayHaveScatteredPointsThatWereOftenObserved) {
  add_square({0, 0, 2}, 8, 50, Certainty::sure, 3 * step_m);
  EXPECT_EQ(gone(), std::vector<std::size_t>{64});
}

TEST_F(SurfaceInFreeSpace, IsFreedFromTheNoiseBeforeAndBehindIt) {
  add_square({0, 0, 2}, 10, 50, Certainty::sure);
  add_square({0, 0, 2 - 2 * step_m}, 10, 20, Certainty::sure);
  add_square({0, 0, 2 + 2 * step_m}, 10, 20, Certainty::sure);
  EXPECT_EQ(gone(), std::vector<std::size_t>{100});
}

TEST_F(SurfaceInFreeSpace, HasTwoSidesIfBothAreSeenAsOften) {
  add_square({0, 0, 2}, 10, 50, Certainty::sure);
  add_square({0, 0, 2 + 2 * step_m}, 10, 30, Certainty::sure);
  EXPECT_EQ(gone(), std::vector<std::size_t>{200});
}

TEST_F(SurfaceInFreeSpace, IsOnePieceAcrossSmallGaps) {
  add_square({-0.4, 0, 2}, 10, 50, Certainty::sure);
  add_square({0.08, 0, 2}, 10, 50, Certainty::sure);  // 12 cm to the right of the other
  add_square({-0.4, -0.6, 2}, 6, 50, Certainty::sure);
  EXPECT_EQ(gone(), (std::vector<std::size_t>{200, 36}));
}

}  // namespace
}  // namespace tofmap
