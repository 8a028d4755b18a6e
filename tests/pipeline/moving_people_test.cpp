// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include <tofmap/mapping/moving_regions.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap::test {
namespace {

/// A walk of two seconds through the room, behind one person.
Simulator room_with_a_person() {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.people = 1;
  options.frames = 344;  // a usual pace over the whole path, of which the test takes the beginning
  return {make_scene("room"), options};
}

/// The pixels of some frames that see the person, or the room, and those of them that were erased.
struct Counts {
  double seen = 0;
  double erased = 0;

  double share() const { return erased / seen; }
};

TEST(MovingPeople, AreErasedAndTheRoomIsNot) {
  constexpr int frames = 40;
  constexpr int frames_until_noticed = 10;
  Simulator simulator = room_with_a_person();
  Counts person;
  Counts room;
  MapHooks hooks;
  hooks.keep_going = [](int done) { return done < frames; };
  std::map<int, std::shared_ptr<const SurfaceCloud>> clouds;
  hooks.on_frame = [&](const Frame&, const PreparedFrame& frame) {
    clouds[frame.index] = frame.cloud;
  };
  hooks.on_motion = [&](int index, const SurfaceCloud& still) {
    clouds[index] = std::make_shared<const SurfaceCloud>(still);
  };
  MapRun run(simulator.sensor(), {});
  run.advance(simulator, hooks);
  for (const auto& [index, cloud] : clouds) {
    if (index < frames_until_noticed) continue;
    const SimulatedFrame truth = simulator.simulate(index);
    for (int row = 0; row < truth.moving.rows(); ++row) {
      for (int col = 0; col < truth.moving.cols(); ++col) {
        Counts& counts = truth.moving(row, col) != 0 ? person : room;
        if (std::isnan(truth.range_truth_m(row, col))) continue;
        ++counts.seen;
        const SurfacePoint& point = cloud->at(col, row);
        counts.erased += point.has_position() && !moves(point) ? 0 : 1;
      }
    }
  }
  ASSERT_GT(person.seen, 0.03 * room.seen);
  EXPECT_GT(person.share(), 0.8);
  // Some are flying pixels, which the filters drop.
  EXPECT_LT(room.share(), 0.1);
}

TEST(MovingPeople, WhoAreThereFromTheBeginningDoNotTakeTheCameraWithThem) {
  // Two people near the camera cover a third of its image, and walk on with it.
  constexpr int frames = 16;
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.people = 2;
  options.people_range_m = 1;
  Simulator simulator(make_scene("hall"), options);
  MapHooks hooks;
  hooks.keep_going = [](int done) { return done < frames; };
  const RoomMap map = map_room(simulator, {}, hooks);
  ASSERT_GE(static_cast<int>(map.trajectory.size()), frames);
  const Pose first = simulator.simulate(0).world_from_camera;
  for (int i = 1; i < frames; ++i) {
    const Pose truth = first.inverse() * simulator.simulate(i).world_from_camera;
    const Pose& found = map.trajectory[static_cast<std::size_t>(i)].world_from_camera;
    EXPECT_LT((truth.inverse() * found).translation().norm(), 0.01) << i;
  }
}

TEST(MovingPeople, DoNotTakeTheCameraWithThem) {
  constexpr int frames = 60;
  Simulator simulator = room_with_a_person();
  MapHooks hooks;
  hooks.keep_going = [](int done) { return done < frames; };
  const RoomMap map = map_room(simulator, {}, hooks);
  ASSERT_GE(static_cast<int>(map.trajectory.size()), frames);
  const Pose first = simulator.simulate(0).world_from_camera;
  const Pose last =
      simulator.simulate(static_cast<int>(map.trajectory.size()) - 1).world_from_camera;
  const Pose error = map.trajectory.back().world_from_camera.inverse() * (first.inverse() * last);
  EXPECT_LT(error.translation().norm(), 0.01);
}

}  // namespace
}  // namespace tofmap::test
