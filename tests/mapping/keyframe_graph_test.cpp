// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/box_ranges.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/mapping/keyframe_graph.hpp>

namespace tofmap {
namespace {

Pose at(double x_m) { return test::moved_by({0, 0, 0}, {x_m, 0, 0}); }

/// A spread with this standard deviation in translation, and a tenth of it in radians.
PoseSpread spread(double sigma_m) { return {0.01 * sigma_m * sigma_m, sigma_m * sigma_m}; }

const PoseSpread small_spread = spread(0.002);

/// A camera that goes ten metres along x and back again, a keyframe a metre, each connected with
/// the one before it.
KeyframeGraph there_and_back() {
  KeyframeGraph graph;
  for (int id = 0; id <= 20; ++id) {
    graph.add({id, id, 0.1 * id, at(id <= 10 ? id : 20 - id), {}});
    if (id > 0) graph.connect(id - 1, id, small_spread);
  }
  return graph;
}

std::vector<int> ids(const std::vector<const Keyframe*>& keyframes) {
  std::vector<int> all;
  for (const Keyframe* keyframe : keyframes) all.push_back(keyframe->id);
  return all;
}

TEST(KeyframeGraph, ReachesNoFurtherThanATrustedChain) {
  const KeyframeGraph graph = there_and_back();
  // Number 0 is where number 20 is, but twenty constraints away.
  EXPECT_EQ(ids(graph.around(20, at(0), 5, {1, 1})), (std::vector<int>{16, 17, 18, 19, 20}));
}

TEST(KeyframeGraph, TakesTheNearestOnceTheyAreConnected) {
  KeyframeGraph graph = there_and_back();
  graph.connect(0, 20, small_spread);
  EXPECT_EQ(ids(graph.around(20, at(0), 5, {1, 1})), (std::vector<int>{0, 1, 18, 19, 20}));
}

/// Three keyframes before a bare wall, along which the camera was lost between the first two.
KeyframeGraph past_a_bare_wall() {
  KeyframeGraph graph;
  for (int id = 0; id < 3; ++id) graph.add({id, id, 0.1 * id, at(id), {}});
  graph.connect(0, 1, spread(0.3));
  graph.connect(1, 2, spread(0.04));
  return graph;
}

std::vector<int> well_connected(const KeyframeGraph& graph, int id) {
  std::vector<int> ids;
  for (const auto& [other, spread] : graph.well_connected_to(id)) ids.push_back(other);
  return ids;
}

TEST(KeyframeGraph, DoesNotConnectWellKeyframesWhoseRelativePoseIsUncertain) {
  KeyframeGraph graph = past_a_bare_wall();
  EXPECT_EQ(well_connected(graph, 1), std::vector{1});
  EXPECT_EQ(ids(graph.around(1, at(0), 5, {1, 1})), (std::vector<int>{1}));
  // Registered again, with more in view.
  graph.connect(2, 1, spread(0.01));
  EXPECT_EQ(well_connected(graph, 1), (std::vector{1, 2}));
}

TEST(KeyframeGraph, AddsUpTheUncertaintyOfRegistrations) {
  KeyframeGraph graph = there_and_back();
  graph.connect(3, 4, spread(0.001));
  // Two registrations of 2 mm and one of 1 mm lead to number 4.
  const auto spreads = graph.spreads_from(1);
  EXPECT_NEAR(spreads[4]->translation_sigma_m(), 0.003, 1e-9);
  EXPECT_NEAR(graph.well_connected_to(1).at(4).translation_sigma_m(), 0.003, 1e-9);
  EXPECT_NEAR(spreads[4]->rotation_sigma_rad(), 0.0003, 1e-9);
  EXPECT_EQ(spreads[1]->translation_m2, 0);
}

TEST(KeyframeGraph, KnowsThePathThatIsMostCertain) {
  KeyframeGraph graph = past_a_bare_wall();
  EXPECT_NEAR(graph.spreads_from(0)[2]->translation_sigma_m(), std::hypot(0.3, 0.04), 1e-9);
  graph.connect(0, 2, spread(0.01));  // a loop
  EXPECT_NEAR(graph.spreads_from(0)[2]->translation_sigma_m(), 0.01, 1e-9);
  EXPECT_NEAR(graph.spreads_from(0)[1]->translation_sigma_m(), std::hypot(0.01, 0.04), 1e-9);
  graph.add({3, 3, 0.3, at(3), {}});
  EXPECT_FALSE(graph.spreads_from(0)[3]);
}

TEST(KeyframeGraph, ReconnectsKeyframesThatALoopHasConnected) {
  // A ring of eight keyframes with one loose registration, which a loop closes.
  KeyframeGraph graph;
  for (int id = 0; id < 8; ++id) {
    graph.add({id, id, 0.1 * id, at(id), {}});
    if (id > 0) graph.connect(id - 1, id, id == 4 ? spread(0.3) : small_spread);
  }
  const auto is_well_connected = [&] { return graph.well_connected_to(3).contains(4); };
  graph.reconnect();
  EXPECT_FALSE(is_well_connected());
  graph.connect(0, 7, small_spread);
  EXPECT_FALSE(is_well_connected()) << "seven registrations lead there";
  graph.reconnect();
  EXPECT_TRUE(is_well_connected());
}

TEST(KeyframeGraph, ForgetsWhatLoopsHaveConnected) {
  KeyframeGraph graph = past_a_bare_wall();
  graph.connect_by_loop(0, 2, spread(0.01));
  graph.connect_by_loop(1, 2, spread(0.001));
  graph.reconnect();
  EXPECT_EQ(well_connected(graph, 0), (std::vector{0, 1, 2}));
  graph.forget_loops();
  EXPECT_NEAR(graph.spreads_from(0)[2]->translation_sigma_m(), std::hypot(0.3, 0.04), 1e-9);
  EXPECT_EQ(well_connected(graph, 0), std::vector{0});
  // What is registered stays.
  graph.connect(0, 2, spread(0.02));
  graph.forget_loops();
  EXPECT_EQ(well_connected(graph, 0), (std::vector{0, 2}));
}

TEST(KeyframeGraph, MeasuresRotationsAsWell) {
  KeyframeGraph graph;
  graph.add({0, 0, 0, at(0), {}});
  graph.add({1, 1, 0.1, test::moved_by({0, 1.5, 0}, {0, 0, 0}), {}});
  graph.add({2, 2, 0.2, at(1), {}});
  graph.connect(0, 1, small_spread);
  graph.connect(0, 2, small_spread);
  // A metre is two steps, 1.5 radians are three turns.
  EXPECT_EQ(ids(graph.around(0, at(0), 2, {0.5, 0.5})), (std::vector<int>{2, 0}));
}

TEST(KeyframeGraph, HoldsAtLeastTheKeyframeItself) {
  KeyframeGraph graph;
  graph.add({0, 0, 0, at(3), {}});
  EXPECT_EQ(ids(graph.around(0, at(0), 1, {1, 1})), (std::vector<int>{0}));
  graph.set_pose(0, at(4));
  EXPECT_EQ(graph[0].world_from_camera.translation().x(), 4);
}

TEST(KeyframeGraph, MovesAMapIntoAnotherOne) {
  KeyframeGraph graph;
  for (int id = 0; id < 4; ++id) {
    graph.add({.id = id, .world_from_camera = at(id), .map = id / 2});
  }
  graph.join(1, 0, at(10));
  const std::vector<double> expected_m{0, 1, 12, 13};
  for (int id = 0; id < 4; ++id) {
    EXPECT_EQ(graph[id].map, 0);
    EXPECT_TRUE(graph[id].world_from_camera.isApprox(at(expected_m[id]))) << id;
  }
}

TEST(KeyframeGraph, SeparatesMapsThatWereJoined) {
  KeyframeGraph graph;
  for (int id = 0; id < 4; ++id) {
    graph.add({.id = id, .world_from_camera = at(id), .map = 0, .taken_in = id / 2});
    if (id > 0) graph.connect(id - 1, id, small_spread);
  }
  graph.assign_maps(std::vector{0, 1});
  for (int id = 0; id < 4; ++id) {
    EXPECT_EQ(graph[id].map, id / 2);
    EXPECT_TRUE(graph[id].world_from_camera.isApprox(at(id))) << id;
    const int first_of_map = 2 * (id / 2);
    EXPECT_EQ(well_connected(graph, id), (std::vector{first_of_map, first_of_map + 1}));
  }
}

TEST(KeyframeGraph, ForgetsTheNewestKeyframes) {
  KeyframeGraph graph;
  for (int id = 0; id < 4; ++id) graph.add({.id = id, .world_from_camera = at(id)});
  graph.connect(0, 1, small_spread);
  graph.connect(2, 3, small_spread);
  graph.shrink(2);
  EXPECT_EQ(graph.size(), 2);
  graph.add({.id = 2, .world_from_camera = at(2)});
  EXPECT_EQ(ids(graph.around(2, at(2), 5, {1, 1})), std::vector{2}) << "it has no connections yet";
}

}  // namespace
}  // namespace tofmap
