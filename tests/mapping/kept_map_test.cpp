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

/// A copy, so that no test changes what is kept.
class KeptMap : public testing::TestWithParam<std::string> {
 protected:
  KeptMap() { fs::copy_file(fs::path(TOFMAP_KEPT_MAPS) / GetParam(), file_); }

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
  EXPECT_EQ(content.edges.size(), 39U);
  EXPECT_EQ(content.loops.size(), 3U);
  EXPECT_EQ(voxel_count(content), 14622U);
  for (const Keyframe& keyframe : content.keyframes.all()) {
    EXPECT_EQ(keyframe.cloud.load()->size(), 64U * 52U) << keyframe.id;
  }
  ASSERT_EQ(content.changes.size(), 1U);
  EXPECT_EQ(content.changes[0].kind, ChangeKind::appeared);
  EXPECT_EQ(content.changes[0].after.size(), 24U);
  EXPECT_EQ(surface_of(content, 0).size(), 3932U);
  EXPECT_EQ(store.frame_rows(0).size(), 36U);
}

TEST_P(KeptMap, IsWrittenAgainAsItIsStored) {
  MapStore store = MapStore::open(file_, MapStore::Access::extend);
  const MapContent content = store.content();
  MapStore::Commit commit(store);
  commit.write(content);
  commit.finish();
  store.settle();
  const MapContent again = MapStore::open(file_).content();
  EXPECT_EQ(again.keyframes.size(), content.keyframes.size());
  EXPECT_EQ(surface_of(again, 0).size(), surface_of(content, 0).size());
}

INSTANTIATE_TEST_SUITE_P(Versions, KeptMap, testing::Values("version_1.db"),
                         [](const auto& file) { return fs::path(file.param).stem().string(); });

}  // namespace
}  // namespace tofmap
