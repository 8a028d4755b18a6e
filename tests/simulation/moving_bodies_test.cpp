// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

SimulatorOptions busy_options() {
  SimulatorOptions options = test::ideal_camera();
  options.people = 3;
  options.people_paths = PeoplePaths::both;
  options.doors = 3;
  return options;
}

/// The simulator of a scene with people and doors. All tests share it, since planning takes time.
const Simulator& busy_simulator(const std::string& scene) {
  static std::map<std::string, Simulator> simulators;
  const auto found = simulators.find(scene);
  if (found != simulators.end()) return found->second;
  return simulators.try_emplace(scene, make_scene(scene), busy_options()).first->second;
}

/// People and doors are looked at from time to time.
class MovingBodiesInScene : public testing::TestWithParam<std::string> {
 protected:
  MovingBodiesInScene() : simulator_(busy_simulator(GetParam())) {}

  const MovingBodies& bodies() const { return simulator_.bodies(); }
  double end_s() const { return simulator_.trajectory().back().timestamp_s; }

  /// The nearest camera pose.
  const Pose& camera_at(double time_s) const {
    const auto frame = static_cast<std::size_t>(std::lround(time_s * 15));
    const Trajectory& poses = simulator_.trajectory();
    return poses[std::min(frame, poses.size() - 1)].world_from_camera;
  }

  bool is_hidden(const Vector3d& from, const Vector3d& to) const {
    const Vector3d way = to - from;
    return way.norm() > 0 && simulator_.rays().cast(from, way.normalized(), way.norm()).has_value();
  }

  const Simulator& simulator_;
};

constexpr double look_every_s = 0.37;

TEST_P(MovingBodiesInScene, ArePeopleAndDoors) {
  EXPECT_FALSE(bodies().doors().empty());
  std::size_t most = 0;
  for (double time_s = 0; time_s <= end_s(); time_s += look_every_s) {
    most = std::max(most, bodies().people_at(time_s).size());
  }
  EXPECT_EQ(most, 3U);
}

TEST_P(MovingBodiesInScene, PeopleStandOnTheFloor) {
  int on_floor = 0;
  for (double time_s = 0; time_s <= end_s(); time_s += look_every_s) {
    for (const PersonStance& person : bodies().people_at(time_s)) {
      const auto hit =
          simulator_.rays().cast(person.foot_m + Vector3d(0, 0, 0.5), -Vector3d::UnitZ(), 10);
      if (!hit) continue;
      EXPECT_NEAR(hit->range_m, 0.5, 1e-3) << time_s;
      ++on_floor;
    }
  }
  // 'slope' has no floor.
  EXPECT_EQ(on_floor > 0, GetParam() != "slope");
}

TEST_P(MovingBodiesInScene, NoPartOfAPersonIsBehindAWall) {
  for (double time_s = 0; time_s <= end_s(); time_s += look_every_s) {
    for (const PersonStance& person : bodies().people_at(time_s)) {
      TriangleMesh body;
      add_person(body, {.height_m = 1.9}, person);
      int hidden = 0;
      for (const Eigen::Vector3f& vertex : body.vertices) {
        const Vector3d point = vertex.cast<double>();
        if (point.z() < person.foot_m.z() + 0.02) continue;
        const Vector3d axis(person.foot_m.x(), person.foot_m.y(), point.z());
        hidden += is_hidden(axis, point) ? 1 : 0;
      }
      EXPECT_EQ(hidden, 0) << time_s << " s, at " << person.foot_m.transpose();
    }
  }
}

TEST_P(MovingBodiesInScene, PeopleKeepAwayFromTheCameraAndFromEachOther) {
  for (double time_s = 0; time_s <= end_s(); time_s += 1.0 / 15) {
    const Vector3d camera_m = camera_at(time_s).translation();
    const std::vector<PersonStance> people = bodies().people_at(time_s);
    for (std::size_t i = 0; i < people.size(); ++i) {
      // 0.65 m are kept at the steps of the plan; between them, everyone moves on.
      EXPECT_GT((people[i].foot_m - camera_m).head<2>().norm(), 0.6) << time_s;
      for (std::size_t j = 0; j < i; ++j) {
        EXPECT_GT((people[i].foot_m - people[j].foot_m).norm(), 0.6) << time_s;
      }
    }
  }
}

TEST_P(MovingBodiesInScene, PeopleDoNotRun) {
  constexpr double step_s = 0.1;
  for (double time_s = 0; time_s + step_s <= end_s(); time_s += step_s) {
    const std::vector<PersonStance> before = bodies().people_at(time_s);
    const std::vector<PersonStance> after = bodies().people_at(time_s + step_s);
    if (before.size() != after.size()) continue;
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_LE((after[i].foot_m - before[i].foot_m).norm() / step_s, 3.1) << time_s;
    }
  }
}

TEST_P(MovingBodiesInScene, LeavesMeetNothingAndKeepAwayFromTheCamera) {
  for (const Door& door : bodies().doors()) {
    EXPECT_GT(door.open_rad, 1);
    for (const StampedPose& pose : simulator_.trajectory()) {
      const Vector3d away = pose.world_from_camera.translation() - door.hinge_m;
      ASSERT_GT(away.head<2>().norm(), Door::width_m + 0.34);
    }
    for (double angle_rad = 0; angle_rad <= door.open_rad; angle_rad += 0.05) {
      const Vector3d along = door.leaf_direction(angle_rad);
      for (const double height_m : {0.05, 0.5, 1.0, 1.5, 1.9}) {
        const Vector3d from = door.hinge_m + 0.05 * along + Vector3d(0, 0, height_m);
        EXPECT_FALSE(is_hidden(from, from + (Door::width_m - 0.06) * along)) << angle_rad;
      }
    }
  }
}

TEST_P(MovingBodiesInScene, DoorsAreSeenOpenAndShut) {
  int moved = 0;
  for (const Door& door : bodies().doors()) {
    double least = door.open_rad;
    double most = 0;
    for (double time_s = 0; time_s <= end_s(); time_s += 0.1) {
      least = std::min(least, door.angle_at(time_s));
      most = std::max(most, door.angle_at(time_s));
    }
    // Recordings of 1.3 s are too short for a whole swing.
    moved += most - least > (end_s() < 2 ? 0.2 : 0.9) * door.open_rad ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MovingBodiesInScene, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

TEST(MovingBodies, AreThereOnlyIfOptionsAskForThem) {
  const Simulator simulator(make_scene("room"), test::ideal_camera());
  EXPECT_TRUE(simulator.bodies().are_none());
  EXPECT_TRUE(simulator.bodies().surface_at(1).triangles.empty());
}

TEST(MovingBodies, PeopleWalkWithTheirFacesAhead) {
  SimulatorOptions options = test::ideal_camera();
  options.people = 2;
  options.people_paths = PeoplePaths::own;
  const Simulator simulator(make_scene("room"), options);
  constexpr double step_s = 0.05;
  int walks = 0;
  int with_face_ahead = 0;
  for (double time_s = 0; time_s < 20; time_s += 0.2) {
    const auto before = simulator.bodies().people_at(time_s);
    const auto after = simulator.bodies().people_at(time_s + step_s);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vector3d velocity = (after[i].foot_m - before[i].foot_m) / step_s;
      if (velocity.norm() < 0.7) continue;
      const double heading_rad = before[i].heading_rad;
      const Vector3d face(std::cos(heading_rad), std::sin(heading_rad), 0);
      ++walks;
      with_face_ahead += face.dot(velocity.normalized()) > 0.7 ? 1 : 0;
    }
  }
  ASSERT_GT(walks, 50);
  // Turning round takes half a second.
  EXPECT_GT(with_face_ahead, 0.85 * walks);
}

}  // namespace
}  // namespace tofmap
