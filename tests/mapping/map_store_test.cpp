// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_store.hpp"

#include "state_json.hpp"
#include "support/scenery.hpp"
#include "support/temporary_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <tofmap/core/error.hpp>
#include <tofmap/mapping/room_mapper.hpp>

namespace tofmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A mapper that has seen some frames of a room.
class StoredMap : public testing::Test {
 protected:
  static constexpr int frames = 24;

  StoredMap() {
    for (int i = 0; i < frames; ++i) add(i);
  }

  void add(int i) { mapper_.add_frame({i, i / 15.0, room_.view(3 * i), false}); }

  std::filesystem::path file() const { return folder_.path() / map_file_name; }

  void store(MapStore& store) const {
    MapStore::Commit commit(store);
    commit.write(mapper_.content());
    commit.finish();
  }

  void make() const {
    MapStore made = MapStore::create(file());
    store(made);
    made.settle();
  }

  /// Executes SQL as another program does.
  void execute(const std::string& sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file().c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sql;
    sqlite3_close(database);
  }

  /// What reading the map throws. Empty if it does not.
  std::string complaint() const {
    try {
      const MapContent content = MapStore::open(file()).content();
      for (const Keyframe& keyframe : content.keyframes.all()) keyframe.cloud.load();
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  test::TemporaryFolder folder_;
  test::Scenery room_{"room"};
  RoomMapper mapper_{room_.camera(), {}, {}, {}, {}};
};

void expect_same(const MapContent& found, const MapContent& expected) {
  ASSERT_EQ(found.keyframes.size(), expected.keyframes.size());
  for (int id = 0; id < found.keyframes.size(); ++id) {
    const Keyframe& one = found.keyframes[id];
    const Keyframe& other = expected.keyframes[id];
    EXPECT_EQ(one.world_from_camera.matrix(), other.world_from_camera.matrix()) << id;
    EXPECT_EQ(one.path_m, other.path_m);
    EXPECT_EQ(one.place.difference(other.place), 0);
    const auto cloud = one.cloud.load();
    const auto expected_cloud = other.cloud.load();
    ASSERT_EQ(cloud->size(), expected_cloud->size());
    EXPECT_EQ(cloud->at(40, 40).getVector3fMap(), expected_cloud->at(40, 40).getVector3fMap());
    EXPECT_TRUE(std::ranges::equal(found.keyframes.links(id), expected.keyframes.links(id)));
  }
  EXPECT_EQ(found.submap_of, expected.submap_of);
  ASSERT_EQ(found.edges.size(), expected.edges.size());
  for (std::size_t i = 0; i < found.edges.size(); ++i) {
    EXPECT_EQ(found.edges[i].covariance, expected.edges[i].covariance);
    EXPECT_EQ(found.edges[i].from_from_to.matrix(), expected.edges[i].from_from_to.matrix());
  }
  EXPECT_EQ(found.loops.size(), expected.loops.size());
  const MapCloud surface = surface_of(found, 0);
  const MapCloud expected_surface = surface_of(expected, 0);
  ASSERT_EQ(surface.size(), expected_surface.size());
  for (std::size_t i = 0; i < surface.size(); ++i) {
    ASSERT_EQ(surface[i].getVector3fMap(), expected_surface[i].getVector3fMap()) << i;
    ASSERT_EQ(surface[i].observations, expected_surface[i].observations) << i;
  }
  ASSERT_EQ(found.frames.size(), expected.frames.size());
  for (std::size_t i = 0; i < found.frames.size(); ++i) {
    const RegisteredFrame& one = found.frames[i];
    const RegisteredFrame& other = expected.frames[i];
    EXPECT_EQ(one.keyframe, other.keyframe) << i;
    EXPECT_EQ(one.keyframe_from_camera.matrix(), other.keyframe_from_camera.matrix()) << i;
    EXPECT_EQ(one.covariance, other.covariance) << i;
    ASSERT_EQ(one.constraints.size(), other.constraints.size()) << i;
    for (std::size_t k = 0; k < one.constraints.size(); ++k) {
      const FrameConstraint& found_constraint = one.constraints[k];
      const FrameConstraint& constraint = other.constraints[k];
      EXPECT_EQ(found_constraint.keyframe, constraint.keyframe) << i;
      EXPECT_EQ(found_constraint.keyframe_from_camera.matrix(),
                constraint.keyframe_from_camera.matrix())
          << i;
      EXPECT_EQ(found_constraint.information, constraint.information) << i;
      EXPECT_EQ(found_constraint.gradient, constraint.gradient) << i;
    }
  }
}

TEST_F(StoredMap, IsReadToTheBit) {
  make();
  expect_same(MapStore::open(file()).content(), mapper_.content());
}

TEST_F(StoredMap, IsBroughtUpToDateByWhatHasChanged) {
  MapStore made = MapStore::create(file());
  store(made);
  for (int i = frames; i < 2 * frames; ++i) {
    add(i);
    if (i % 5 == 0) store(made);
  }
  mapper_.finish();
  store(made);
  made.settle();
  expect_same(MapStore::open(file()).content(), mapper_.content());
}

TEST_F(StoredMap, GoesOnFromItsFileToTheSameBits) {
  MapStore made = MapStore::create(file());
  store(made);
  RoomMapper resumed(room_.camera(), {}, {}, {}, {});
  resumed.restore(made.content(), mapper_.state(), frames);
  for (int i = frames; i < 2 * frames; ++i) {
    add(i);
    resumed.add_frame({i, i / 15.0, room_.view(3 * i), false});
  }
  mapper_.finish();
  resumed.finish();
  expect_same(resumed.content(), mapper_.content());
}

TEST_F(StoredMap, HoldsWhatTheLastCommitWrote) {
  MapStore made = MapStore::create(file());
  store(made);
  const int before = mapper_.content().keyframes.size();
  for (int i = frames; i < 2 * frames; ++i) add(i);
  ASSERT_GT(mapper_.content().keyframes.size(), before);
  {
    MapStore::Commit abandoned(made);
    abandoned.write(mapper_.content());
    abandoned.put("name", "value");
  }
  EXPECT_EQ(made.content().keyframes.size(), before);
  EXPECT_FALSE(made.entry("name"));
  store(made);
  EXPECT_EQ(made.content().keyframes.size(), mapper_.content().keyframes.size());
}

TEST_F(StoredMap, NeedsNoCloudInMemoryThatIsInTheFile) {
  MapStore made = MapStore::create(file());
  for (const Keyframe& keyframe : mapper_.content().keyframes.all()) {
    EXPECT_FALSE(keyframe.cloud.is_aside());
  }
  store(made);
  for (const Keyframe& keyframe : mapper_.content().keyframes.all()) {
    EXPECT_TRUE(keyframe.cloud.is_aside());
    EXPECT_TRUE(keyframe.cloud.load());
  }
}

TEST_F(StoredMap, NeedsNoSubmapInMemoryButTheLatest) {
  const MapContent& content = mapper_.content();
  const auto latest = [&]() -> const SubmapSurface& {
    return content.submaps[*latest_submap(content)].surface;
  };
  ASSERT_GT(*latest_submap(content), 0U);
  EXPECT_FALSE(content.submaps[0].surface.is_aside());
  EXPECT_EQ(submaps_at_rest(content).size(), content.submaps.size() - 1);
  const std::string before = content.submaps[0].surface.load()->to_bytes();
  MapStore made = MapStore::create(file());
  store(made);
  EXPECT_TRUE(content.submaps[0].surface.is_aside());
  EXPECT_FALSE(latest().is_aside());
  EXPECT_THAT(submaps_at_rest(content), testing::IsEmpty());
  EXPECT_EQ(content.submaps[0].surface.load()->to_bytes(), before);
  add(frames);
  EXPECT_TRUE(content.submaps[0].surface.is_aside());
  store(made);
  made.settle();
  expect_same(MapStore::open(file()).content(), content);
}

TEST_F(StoredMap, KeepsEntriesByTheirNames) {
  MapStore made = MapStore::create(file());
  MapStore::Commit commit(made);
  commit.put("run/b", "2");
  commit.put("run/a", std::string_view("1\0x", 3));
  commit.put("running", "3");
  commit.finish();
  EXPECT_EQ(made.entry("run/a"), std::string("1\0x", 3));
  EXPECT_THAT(made.entries("run/"), ElementsAre("run/a", "run/b"));
  MapStore::Commit removal(made);
  removal.remove("run/");
  removal.finish();
  EXPECT_THAT(made.entries(""), ElementsAre("running"));
}

TEST_F(StoredMap, KeepsWhatHasChanged) {
  MapContent content = mapper_.content();
  content.recordings.push_back(content.recordings.front());
  const MapCloud surface = surface_of(content, 0);
  MapChange change;
  change.kind = ChangeKind::moved;
  change.recording = 1;
  change.before.push_back(surface[1]);
  change.after.push_back(surface[2]);
  change.after.push_back(surface[3]);
  change.after_from_before.translation() << 1, 2, 3;
  content.changes = {change};
  {
    MapStore made = MapStore::create(file());
    MapStore::Commit commit(made);
    commit.write(content);
    commit.finish();
    made.settle();
  }
  const std::vector<MapChange> found = MapStore::open(file()).content().changes;
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found[0].kind, ChangeKind::moved);
  EXPECT_EQ(found[0].recording, 1);
  EXPECT_EQ(found[0].after_from_before.matrix(), change.after_from_before.matrix());
  ASSERT_EQ(found[0].before.size(), 1);
  ASSERT_EQ(found[0].after.size(), 2);
  EXPECT_EQ(found[0].after[1].getVector3fMap(), surface[3].getVector3fMap());
  EXPECT_EQ(found[0].after[1].observations, surface[3].observations);
  execute("DELETE FROM properties WHERE name = 'checksum'");
  for (const char* damage :
       {"UPDATE changes SET kind = 'gone'", "UPDATE changes SET recording = 2",
        "UPDATE changes SET before = x'00'", "UPDATE changes SET after = zeroblob(36 * 2 + 1)",
        "UPDATE changes SET motion = zeroblob(128)"}) {
    std::filesystem::copy_file(file(), folder_.path() / "whole");
    execute(damage);
    EXPECT_THAT(complaint(), HasSubstr("changes")) << damage;
    std::filesystem::rename(folder_.path() / "whole", file());
  }
}

TEST_F(StoredMap, IsLockedWhileItIsWritten) {
  MapStore made = MapStore::create(file());
  store(made);
  EXPECT_THAT(complaint(), HasSubstr("is in use by another program"));
  made.settle();
  EXPECT_EQ(complaint(), "");
}

TEST_F(StoredMap, IsRefusedIfItIsNone) {
  EXPECT_THAT(complaint(), HasSubstr("does not exist"));
  std::ofstream(file()) << "no map";
  EXPECT_THAT(complaint(), HasSubstr("is not a map of tofmap"));
  std::filesystem::remove(file());
  execute("CREATE TABLE other (id)");
  EXPECT_THAT(complaint(), HasSubstr("not a map of tofmap"));
  EXPECT_THROW(MapStore::create(file()), InputError);
}

TEST_F(StoredMap, IsRefusedIfItLacksATable) {
  make();
  const std::filesystem::path whole = folder_.path() / "whole.db";
  std::filesystem::copy_file(file(), whole);
  for (const std::string table : {"tracking", "entries", "registrations", "frames"}) {
    execute("DROP TABLE " + table);
    EXPECT_THAT(complaint(), HasSubstr("has no table '" + table + "'; map the"));
    execute("CREATE VIEW " + table + " AS SELECT * FROM keyframes");
    EXPECT_THAT(complaint(), HasSubstr("has no table")) << "a view is none";
    std::filesystem::remove(file());
    std::filesystem::copy_file(whole, file());
  }
}

TEST_F(StoredMap, IsRefusedIfATriggerWouldChangeWhatIsWritten) {
  make();
  execute("CREATE VIEW walls AS SELECT * FROM submaps; CREATE INDEX times ON frames (timestamp_s)");
  EXPECT_EQ(complaint(), "") << "views and indices of its owner change nothing";
  execute("CREATE TRIGGER thief AFTER INSERT ON recordings BEGIN DELETE FROM frames; END");
  EXPECT_THAT(complaint(), HasSubstr("has a trigger, 'thief'"));
}

TEST_F(StoredMap, IsRefusedIfItIsOfALaterVersion) {
  make();
  execute("PRAGMA user_version = 99");
  EXPECT_THAT(complaint(), HasSubstr("version 99"));
}

TEST_F(StoredMap, IsRefusedIfAByteOfItIsFlippedOrItIsCut) {
  make();
  std::ifstream in(file(), std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(in), {});
  const auto write = [&](const std::string& bytes) {
    std::ofstream(file(), std::ios::binary | std::ios::trunc) << bytes;
  };
  int refused = 0;
  int accepted = 0;
  for (std::size_t at = 20; at < whole.size(); at += whole.size() / 97) {
    std::string flipped = whole;
    flipped[at] = static_cast<char>(flipped[at] ^ 16);
    write(flipped);
    ++(complaint().empty() ? accepted : refused);
  }
  EXPECT_GT(refused, 80);
  EXPECT_LT(accepted, 10) << "only bytes that nothing uses may change";
  for (const double share : {0.01, 0.5, 0.99}) {
    write(whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    EXPECT_THAT(complaint(), HasSubstr("damaged")) << share;
  }
}

TEST_F(StoredMap, IsRefusedIfARowWasChanged) {
  make();
  const std::filesystem::path whole = folder_.path() / "whole.db";
  std::filesystem::copy_file(file(), whole);
  for (const char* change :
       {"UPDATE clouds SET width_px = 87 WHERE keyframe = 0",
        "UPDATE constraints SET residual = residual + 1 WHERE id = 0",
        "UPDATE constraints SET error_m = 0 WHERE id = 0",
        "UPDATE keyframes SET timestamp_s = timestamp_s + 9 WHERE id = 1",
        "UPDATE keyframes SET path_m = CAST(path_m AS TEXT) WHERE id = 1",
        "UPDATE frames SET keyframe = 0 WHERE id = (SELECT MAX(id) FROM frames)",
        "UPDATE links SET rotation_rad2 = 1 WHERE keyframe = 0 AND place = 0",
        "UPDATE registrations SET x_m = x_m + 1 WHERE frame = 1",
        "UPDATE recordings SET verdict = 'good'", "UPDATE submaps SET voxels = voxels + 1",
        "DELETE FROM frames WHERE id = 0", "INSERT INTO entries VALUES ('', x'')"}) {
    execute(change);
    EXPECT_THAT(complaint(), HasSubstr("changed by another program")) << change;
    std::filesystem::remove(file());
    std::filesystem::copy_file(whole, file());
  }
}

TEST_F(StoredMap, IsRefusedIfItsTablesContradictEachOther) {
  const std::vector<std::string> damages{
      "UPDATE keyframes SET submap = 77 WHERE id = 1",
      "UPDATE keyframes SET recording = -1 WHERE id = 1",
      "UPDATE keyframes SET rotation = zeroblob(72) WHERE id = 1",
      "UPDATE keyframes SET rotation = x'00' WHERE id = 1",
      "UPDATE keyframes SET x_m = 1e300 WHERE id = 1",
      "UPDATE keyframes SET x_m = 1e6 WHERE id = 1",
      "UPDATE keyframes SET timestamp_s = 'now' WHERE id = 1",
      "UPDATE keyframes SET place = x'00' WHERE id = 1",
      "DELETE FROM clouds WHERE keyframe = 1",
      "UPDATE clouds SET points = zeroblob(100) WHERE keyframe = 1",
      "UPDATE clouds SET width_px = 1000000 WHERE keyframe = 1",
      "UPDATE submaps SET anchor = 1000000 WHERE id = 0",
      "UPDATE submaps SET surface = zeroblob(44) WHERE id = 0",
      "UPDATE submaps SET surface = zeroblob(45) WHERE id = 0",
      "UPDATE constraints SET to_keyframe = from_keyframe WHERE id = 0",
      "UPDATE constraints SET to_keyframe = 1000000 WHERE id = 0",
      "UPDATE constraints SET covariance = zeroblob(288) WHERE id = 0",
      "UPDATE links SET neighbour = 1000000 WHERE keyframe = 0",
      "UPDATE links SET neighbour = keyframe WHERE keyframe = 0",
      "UPDATE frames SET keyframe = 1000000 WHERE id = 0",
      "UPDATE frames SET covariance = x'00' WHERE id = 0",
      "UPDATE registrations SET frame = 1000000 WHERE frame = 1",
      "UPDATE registrations SET keyframe = 1000000 WHERE frame = 1",
      "UPDATE registrations SET x_m = 1e6 WHERE frame = 1",
      "UPDATE registrations SET rotation = zeroblob(36) WHERE frame = 1",
      "UPDATE registrations SET information = x'00' WHERE frame = 1",
      "UPDATE registrations SET gradient = x'0000807f0000807f0000807f0000807f0000807f0000807f'",
      "DROP TABLE registrations",
      "UPDATE recordings SET sensor = '{}'",
      "DELETE FROM recordings",
      "UPDATE properties SET value = '{\"voxel_m\": -1}' WHERE name = 'surface'",
      "UPDATE properties SET value = replace(value, '0.1', '0') WHERE name = 'surface'",
      "UPDATE keyframes SET map = 2147483647 WHERE id = 1",
      "DELETE FROM properties WHERE name = 'surface'",
      "DROP TABLE frames"};
  make();
  execute("DELETE FROM properties WHERE name = 'checksum'");
  EXPECT_EQ(complaint(), "");
  const std::filesystem::path whole = folder_.path() / "whole.db";
  std::filesystem::copy_file(file(), whole);
  for (const std::string& damage : damages) {
    execute(damage);
    EXPECT_THAT(complaint(), HasSubstr(file().string())) << damage;
    std::filesystem::remove(file());
    std::filesystem::copy_file(whole, file());
  }
}

TEST(StoredCovariance, IsOneThatNumbersCanBeComputedWith) {
  using Covariance = Eigen::Matrix<double, 6, 6>;
  EXPECT_NO_THROW(check_covariance(1e-6 * Covariance::Identity()));
  EXPECT_NO_THROW(check_covariance(Covariance::Identity()));
  EXPECT_THROW(check_covariance(1e-300 * Covariance::Identity()), InputError);
  EXPECT_THROW(check_covariance(1e100 * Covariance::Identity()), InputError);
  EXPECT_THROW(check_covariance(-1 * Covariance::Identity()), InputError);
}

}  // namespace
}  // namespace tofmap
