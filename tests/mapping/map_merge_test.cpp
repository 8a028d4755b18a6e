// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/map_merge.hpp"

#include "support/scenery.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const KeyframeSpacing spacing{OdometryOptions().keyframe_translation_m,
                              OdometryOptions().keyframe_rotation_rad};

/// The map of a part of the path through a scene.
MapContent mapped(const test::Scenery& scene, int first, int end, const std::string& added,
                  const SurfaceMapOptions& surface = {}) {
  RoomMapper mapper(scene.camera(), {}, {}, {}, surface);
  mapper.describe_recording(
      {.source = "part", .added = added, .version = "", .options = "", .sensor = {}});
  for (int i = first; i < end; ++i) mapper.add_frame({i, i / 15.0, scene.view(i), false});
  mapper.finish();
  return mapper.content();
}

class MergedRoom : public testing::Test {
 protected:
  static constexpr int begins[] = {100, 140, 180};
  static constexpr int frames = 60;

  /// The room, and the maps of three parts of the path, which all cases share.
  static const test::Scenery& room() {
    static const test::Scenery room("room");
    return room;
  }
  static MapContent part(int i) {
    static std::array<std::optional<MapContent>, 3> parts;
    auto& known = parts[static_cast<std::size_t>(i)];
    if (!known) known = mapped(room(), begins[i], begins[i] + frames, std::to_string(i));
    return *known;
  }

  /// Largest error of the paths of all recordings in the world of a map that began at this frame.
  double worst_error_m(const MapContent& content, int first) const {
    double worst_m = 0;
    const Pose world_from_scene = room().pose(first).inverse();
    for (const RegisteredFrame& frame : content.frames) {
      const Pose truth = world_from_scene * room().pose(frame.index);
      worst_m = std::max(
          worst_m, (truth.translation() - pose_of(frame, content.keyframes).translation()).norm());
    }
    return worst_m;
  }

  /// The largest distance of a frame from where one of its constraints has found it. Infinite if
  /// there are none.
  static double worst_constraint_error_m(const MapContent& content) {
    double worst_m = -1;
    for (const RegisteredFrame& frame : content.frames) {
      const Pose pose = pose_of(frame, content.keyframes);
      for (const FrameConstraint& constraint : frame.constraints) {
        const Pose found = content.keyframes[constraint.keyframe].world_from_camera *
                           Pose(constraint.keyframe_from_camera.cast<double>());
        worst_m = std::max(worst_m, (found.translation() - pose.translation()).norm());
      }
    }
    return worst_m < 0 ? std::numeric_limits<double>::infinity() : worst_m;
  }
};

TEST_F(MergedRoom, IsTheSameInAnyOrder) {
  for (const auto& order : std::vector<std::vector<int>>{{0, 1, 2}, {2, 0, 1}, {0, 2, 1}}) {
    std::vector<MapContent> parts;
    for (const int i : order) parts.push_back(part(i));
    const MergedMaps merged = merge_maps(std::move(parts), spacing, {}, {});
    EXPECT_THAT(merged.is_joined, ElementsAre(true, true, true));
    EXPECT_EQ(merged.content.frames.size(), 3 * frames);
    EXPECT_LT(worst_error_m(merged.content, begins[order.front()]), 0.01);
    EXPECT_LT(worst_constraint_error_m(merged.content), 0.03) << "they go with their keyframes";
    std::vector<std::string> dates;
    for (const MapRecording& recording : merged.content.recordings) {
      dates.push_back(recording.added);
    }
    EXPECT_THAT(dates, ElementsAre("0", "1", "2"));
    EXPECT_TRUE(merged.content.changes.empty());
  }
}

TEST_F(MergedRoom, DoesNotHoldAnotherPlace) {
  const test::Scenery other("flat");
  std::vector<MapContent> parts{part(0), mapped(other, 0, frames, "other"), part(1)};
  const MergedMaps merged = merge_maps(std::move(parts), spacing, {}, {});
  EXPECT_THAT(merged.is_joined, ElementsAre(true, false, true));
  EXPECT_EQ(merged.content.frames.size(), 2 * frames);
  EXPECT_GT(merged.nearness[1].keyframes, 0);
  EXPECT_LT(merged.nearness[1].agreeing, 3);
}

TEST_F(MergedRoom, RefusesMapsThatDoNotGoTogether) {
  const auto complaint = [](std::vector<MapContent> parts) -> std::string {
    try {
      merge_maps(std::move(parts), spacing, {}, {});
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(complaint({part(0), part(0)}), HasSubstr("have a recording in common"));
  SurfaceMapOptions coarse;
  coarse.voxel_m = 0.1;
  EXPECT_THAT(complaint({part(0), mapped(room(), 100, 110, "coarse", coarse)}),
              HasSubstr("other options"));
  EXPECT_THAT(complaint({}), HasSubstr("no map"));
}

TEST_F(MergedRoom, CanBeGivenUp) {
  struct GivenUp {};
  EXPECT_THROW(
      merge_maps({part(0), part(1)}, spacing, {}, {}, [](std::size_t) { throw GivenUp(); }),
      GivenUp);
}

}  // namespace
}  // namespace tofmap
