// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Maps that earlier versions wrote (tests/mapping/maps) are read by this one.

#include "support/temporary_folder.hpp"
#include "tofmap/mapping/map_store.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tofmap {
namespace {

namespace fs = std::filesystem;

/// A kept map, and what it holds.
struct Kept {
  std::string name;
  std::size_t constraints;  ///< between keyframes
  std::size_t loops;
  std::size_t voxels;
  std::size_t points;
  std::size_t changed_points;
  std::size_t registrations;  ///< of frames with keyframes
};

/// A copy, so that no test changes what is kept.
class KeptMap : public testing::TestWithParam<Kept> {
 protected:
  KeptMap() { fs::copy_file(fs::path(TOFMAP_KEPT_MAPS) / GetParam().name, file_); }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_.path() / map_file_name;
};

TEST_P(KeptMap, IsReadWhole) {
  const MapStore store = MapStore::open(file_);
  const MapContent content = store.content();
  ASSERT_EQ(content.recordings.size(), 2U);
  EXPECT_EQ(content.recordings[0].source, "first");
  EXPECT_EQ(content.recordings[1].verdict, "good");
  EXPECT_EQ(content.camera.width_px, 64);
  EXPECT_EQ(content.surface_options.voxel_m, 0.2);
  EXPECT_EQ(content.keyframes.size(), 16);
  EXPECT_EQ(content.frames.size(), 72U);
  EXPECT_EQ(content.edges.size(), GetParam().constraints);
  EXPECT_EQ(content.loops.size(), GetParam().loops);
  EXPECT_EQ(voxel_count(content), GetParam().voxels);
  for (const Keyframe& keyframe : content.keyframes.all()) {
    EXPECT_EQ(keyframe.cloud.load()->size(), 64U * 52U) << keyframe.id;
  }
  ASSERT_EQ(content.changes.size(), 1U);
  EXPECT_EQ(content.changes[0].kind, ChangeKind::appeared);
  EXPECT_EQ(content.changes[0].after.size(), GetParam().changed_points);
  EXPECT_EQ(surface_of(content, 0).size(), GetParam().points);
  EXPECT_EQ(store.frame_rows(0).size(), 36U);
  std::size_t registrations = 0;
  for (const RegisteredFrame& frame : content.frames) registrations += frame.constraints.size();
  EXPECT_EQ(registrations, GetParam().registrations);
}

TEST_P(KeptMap, IsWrittenAgainAsItIsStored) {
  MapStore store = MapStore::open(file_, MapStore::Access::extend);
  MapContent content = store.content();
  content.frames[5].constraints.push_back({.keyframe = 3});  // no table of version 1 has these
  MapStore::Commit commit(store);
  commit.write(content);
  commit.finish();
  store.settle();
  const MapContent again = MapStore::open(file_).content();
  EXPECT_EQ(again.frames[5].constraints.size(), content.frames[5].constraints.size());
  EXPECT_EQ(again.frames[5].constraints.back().keyframe, 3);
  EXPECT_EQ(again.keyframes.size(), content.keyframes.size());
  EXPECT_EQ(surface_of(again, 0).size(), surface_of(content, 0).size());
}

INSTANTIATE_TEST_SUITE_P(Versions, KeptMap,
                         testing::Values(Kept{.name = "version_1.db",
                                              .constraints = 39,
                                              .loops = 3,
                                              .voxels = 14622,
                                              .points = 3932,
                                              .changed_points = 24,
                                              .registrations = 0},
                                         Kept{.name = "version_2.db",
                                              .constraints = 42,
                                              .loops = 6,
                                              .voxels = 14711,
                                              .points = 3948,
                                              .changed_points = 25,
                                              .registrations = 184}),
                         [](const auto& kept) {
                           return fs::path(kept.param.name).stem().string();
                         });

}  // namespace
}  // namespace tofmap
