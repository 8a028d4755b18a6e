// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/contradicted_loops.hpp"

#include "support/scenery.hpp"

#include <gtest/gtest.h>

namespace tofmap {
namespace {

/// A map of two keyframes of each of two recordings.
class LoopsOfTwoRecordings : public testing::Test {
 protected:
  LoopsOfTwoRecordings() {
    for (int id = 0; id < 4; ++id) {
      content_.keyframes.add({.id = id,
                              .frame_index = id % 2,
                              .world_from_camera = room_.pose(10 * id),
                              .cloud = room_.view(10 * id),
                              .recording = id / 2});
    }
  }

  void add_loop(int from, int to, bool is_used) {
    content_.edges.push_back({.from = from, .to = to, .may_be_wrong = true});
    content_.loops.push_back({.from_frame = from, .to_frame = to, .is_used = is_used});
  }

  /// The surface that a keyframe sees is new in the second recording.
  void add_change_seen_by(int id) {
    MapChange change;
    change.kind = ChangeKind::appeared;
    change.recording = 1;
    for (const SurfacePoint& point : content_.keyframes[id].cloud.load()->points) {
      if (!point.has_normal()) continue;
      MapPoint changed;
      changed.getVector3fMap() =
          (content_.keyframes[id].world_from_camera * point.getVector3fMap().cast<double>())
              .cast<float>();
      change.after.push_back(changed);
    }
    content_.changes.push_back(change);
  }

  test::Scenery room_{"room"};
  MapContent content_{room_.camera(), {}};
};

TEST_F(LoopsOfTwoRecordings, AreThoseThatTheFitRejects) {
  add_loop(0, 1, true);
  add_loop(0, 3, true);
  EXPECT_EQ(contradicted_loops(content_), 0);
  add_loop(2, 3, false);
  add_loop(1, 3, false);
  EXPECT_EQ(contradicted_loops(content_), 2);
}

TEST_F(LoopsOfTwoRecordings, AreExplainedByWhatHasChangedBetweenThem) {
  add_loop(0, 2, true);
  add_loop(0, 3, true);
  add_loop(1, 3, false);
  add_loop(2, 3, false);
  add_change_seen_by(3);
  // The loop within the second recording is not between the times that the change is between.
  EXPECT_EQ(contradicted_loops(content_), 1);
}

TEST_F(LoopsOfTwoRecordings, AreNotExplainedIfMostAreRejected) {
  add_loop(0, 2, true);
  add_loop(1, 3, false);
  add_change_seen_by(3);
  EXPECT_EQ(contradicted_loops(content_), 1);
}

}  // namespace
}  // namespace tofmap
