// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/keyframe_cloud.hpp"

#include "support/box_room.hpp"

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

SurfaceCloud wall(double far_m) {
  const CameraModel camera = test::small_camera();
  return surface_cloud(
      test::box_ranges(camera, {-50, -50, -50}, {50, 50, far_m}, Pose::Identity(), 0.01F),
      pixel_rays(camera), {});
}

std::size_t bytes_of_one() { return wall(4).size() * sizeof(SurfacePoint); }

TEST(CloudShelf, GivesBackWhatIsPutOnIt) {
  CloudShelf shelf(test::small_camera());
  const KeyframeCloud near = shelf.add(wall(4));
  const KeyframeCloud far = shelf.add(wall(9));
  EXPECT_NEAR(near.load()->at(44, 36).z, 4, 1e-3);
  EXPECT_NEAR(far.load()->at(44, 36).z, 9, 1e-3);
  EXPECT_NE(near.number(), far.number());
}

TEST(CloudShelf, KeepsAsManyExpandedCloudsAsItsBudgetAllows) {
  CloudShelf shelf(test::small_camera(), 2 * bytes_of_one());
  std::vector<KeyframeCloud> clouds;
  for (int i = 0; i < 5; ++i) clouds.push_back(shelf.add(wall(4 + i)));
  EXPECT_EQ(shelf.expanded_bytes(), 0U);
  for (const KeyframeCloud& cloud : clouds) cloud.load();
  EXPECT_EQ(shelf.expanded_bytes(), 2 * bytes_of_one());
  const auto before = clouds[4].load();
  clouds[0].load();
  EXPECT_EQ(clouds[4].load(), before) << "the one that was used last was forgotten";
  const auto held = clouds[1].load();
  clouds[2].load();
  clouds[3].load();
  EXPECT_NEAR(held->at(44, 36).z, 5, 1e-3) << "a cloud that is held was freed";
}

TEST(CloudShelf, ForgetsWhatExceedsANewBudget) {
  CloudShelf shelf(test::small_camera());
  std::vector<KeyframeCloud> clouds;
  for (int i = 0; i < 3; ++i) clouds.push_back(shelf.add(wall(4 + i)));
  for (const KeyframeCloud& cloud : clouds) cloud.load();
  EXPECT_EQ(shelf.expanded_bytes(), 3 * bytes_of_one());
  shelf.set_budget(0);
  EXPECT_EQ(shelf.expanded_bytes(), bytes_of_one()) << "not the one that was used last alone";
  EXPECT_NEAR(clouds[0].load()->at(44, 36).z, 4, 1e-3);
  EXPECT_EQ(shelf.expanded_bytes(), bytes_of_one());
}

TEST(CloudShelf, FreesCloudsWithTheirOwners) {
  CloudShelf shelf(test::small_camera());
  {
    const KeyframeCloud cloud = shelf.add(wall(4));
    cloud.load();
    EXPECT_EQ(shelf.expanded_bytes(), bytes_of_one());
  }
  EXPECT_EQ(shelf.expanded_bytes(), 0U);
}

TEST(KeyframeCloud, IsReadAgainAfterItWasPutAside) {
  CloudShelf shelf(test::small_camera(), 0);
  const KeyframeCloud cloud = shelf.add(wall(4));
  const CompactCloud kept = cloud.compact();
  int reads = 0;
  EXPECT_FALSE(cloud.is_aside());
  cloud.put_aside([&] {
    ++reads;
    return kept;
  });
  EXPECT_TRUE(cloud.is_aside());
  EXPECT_NEAR(cloud.load()->at(44, 36).z, 4, 1e-3);
  EXPECT_EQ(reads, 1);
  cloud.load();
  EXPECT_EQ(reads, 1) << "the cloud that was used last stays expanded";
}

TEST(KeyframeCloud, OnNoShelfStaysAsItIs) {
  const auto plain = std::make_shared<const SurfaceCloud>(wall(4));
  const KeyframeCloud cloud = plain;
  EXPECT_EQ(cloud.load(), plain);
  EXPECT_THROW(cloud.compact(), UsageError);
  EXPECT_EQ(KeyframeCloud().load(), nullptr);
}

}  // namespace
}  // namespace tofmap
