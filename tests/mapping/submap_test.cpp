// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/submap.hpp"

#include "support/scenery.hpp"

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// The surface of a submap, and a frame that can be added to it.
class SubmapOfRoom : public testing::Test {
 protected:
  void add_frame(SubmapSurface& surface) const {
    surface.change().integrate(*frame_, Pose::Identity());
  }

  /// Puts a surface aside. `reads_` counts how often it is read.
  void put_aside(const SubmapSurface& surface) {
    surface.put_aside([this, bytes = surface.load()->to_bytes()] {
      ++reads_;
      return surface_from_bytes(bytes, {});
    });
  }

  test::Scenery room_{"room"};
  std::shared_ptr<const SurfaceCloud> frame_ = room_.view(0);
  int reads_ = 0;
};

TEST_F(SubmapOfRoom, IsSharedUntilACopyIsChanged) {
  SubmapSurface surface{SurfaceMap({})};
  add_frame(surface);
  const SubmapSurface copy = surface;
  EXPECT_EQ(copy.load(), surface.load());
  EXPECT_EQ(copy.revision(), surface.revision());
  const std::string before = copy.load()->to_bytes();
  add_frame(surface);
  EXPECT_EQ(copy.load()->to_bytes(), before);
  EXPECT_NE(surface.load()->to_bytes(), before);
  EXPECT_NE(copy.revision(), surface.revision());
}

TEST_F(SubmapOfRoom, StaysAsItWasForWhoeverHoldsIt) {
  SubmapSurface surface{SurfaceMap({})};
  add_frame(surface);
  const auto held = surface.load();
  const std::string before = held->to_bytes();
  add_frame(surface);
  EXPECT_EQ(held->to_bytes(), before);
}

TEST_F(SubmapOfRoom, IsReadWhenItIsNeeded) {
  SubmapSurface surface{SurfaceMap({})};
  add_frame(surface);
  const std::string before = surface.load()->to_bytes();
  const std::size_t size = surface.size();
  const std::uint64_t revision = surface.revision();
  put_aside(surface);
  EXPECT_TRUE(surface.is_aside());
  EXPECT_EQ(surface.size(), size);
  EXPECT_EQ(surface.revision(), revision);
  EXPECT_EQ(reads_, 0);
  EXPECT_EQ(surface.load()->to_bytes(), before);
  EXPECT_EQ(reads_, 1);
  EXPECT_TRUE(surface.is_aside());
}

TEST_F(SubmapOfRoom, GoesOnFromWhatWasPutAside) {
  SubmapSurface surface{SurfaceMap({})};
  SubmapSurface in_memory{SurfaceMap({})};
  for (SubmapSurface* one : {&surface, &in_memory}) add_frame(*one);
  put_aside(surface);
  const SubmapSurface copy = surface;
  for (SubmapSurface* one : {&surface, &in_memory}) add_frame(*one);
  EXPECT_FALSE(surface.is_aside());
  EXPECT_TRUE(copy.is_aside());
  EXPECT_EQ(surface.load()->to_bytes(), in_memory.load()->to_bytes());
  EXPECT_NE(surface.revision(), copy.revision());
}

}  // namespace
}  // namespace tofmap
