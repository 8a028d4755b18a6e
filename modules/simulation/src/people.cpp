// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "people.hpp"

#include "noise.hpp"
#include "own_walk.hpp"

#include <algorithm>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double least_person_gap_m = 0.65;  ///< between the middles of two people

/// The look of a person, drawn by a key.
PersonLook drawn_look(std::uint64_t key) {
  const auto between = [&key](double low, double high) {
    return low + (high - low) * share_of(key++);
  };
  return {.height_m = between(1.6, 1.9),
          .skin = between(0.5, 0.7),
          .hair = between(0.08, 0.4),
          .shirt = between(0.15, 0.85),
          .trousers = between(0.08, 0.5),
          .shoes = between(0.05, 0.3)};
}

bool keeps_clear(const std::vector<WalkedPlaces>& others, int step, const Vector3d& foot_m) {
  return std::ranges::none_of(others, [&](const WalkedPlaces& other) {
    const auto& place = other[static_cast<std::size_t>(step)];
    return place && (*place - foot_m).norm() < least_person_gap_m;
  });
}

/// The walk of a person who keeps out of the way of others, whose walks are planned already.
template <class Wish>
WalkedPlaces planned_walk(const WalkSurroundings& around, const Wish& wish,
                          const std::vector<WalkedPlaces>& others) {
  WalkedPlaces walk = cheapest_walk(around.steps.count(), around.steps.step_s, [&](int step) {
    std::vector<WalkPlace> places = wish.places(step);
    std::erase_if(places,
                  [&](const WalkPlace& place) { return !keeps_clear(others, step, place.foot_m); });
    return places;
  });
  smooth_walk(walk, [&](int step, const Vector3d& foot_m) {
    const Pose& camera = around.steps.poses[static_cast<std::size_t>(step)].world_from_camera;
    const double gap_m = (camera.translation() - foot_m).head<2>().norm();
    return around.space.standing_place(foot_m) && gap_m >= least_camera_gap_m &&
           keeps_clear(others, step, foot_m);
  });
  for (auto& place : walk) {
    if (place) place = around.space.standing_place(*place);
  }
  return walk;
}

bool walks_ahead(PeoplePaths paths, int person) {
  return paths == PeoplePaths::ahead || (paths == PeoplePaths::both && person % 2 == 0);
}

}  // namespace

std::vector<Walker> walking_people(const WalkSurroundings& around,
                                   const SimulatorOptions& options) {
  std::vector<Walker> people;
  std::vector<WalkedPlaces> walks;
  std::vector<OwnWalk> own;
  int ahead = 0;
  for (int person = 0; person < options.people; ++person) {
    const std::uint64_t key =
        mix(mix(static_cast<std::uint64_t>(options.seed)) + 77 + static_cast<unsigned>(person));
    if (walks_ahead(options.people_paths, person)) {
      walks.push_back(planned_walk(around, WalkAhead(around, options, ahead++, key + 100), walks));
    } else {
      const auto walk = find_own_walk(around, own, key + 200);
      if (!walk) continue;
      own.push_back(*walk);
      walks.push_back(planned_walk(around, *walk, walks));
    }
    people.emplace_back(drawn_look(key), walks.back(), around.steps.start_s(), around.steps.step_s);
  }
  return people;
}

}  // namespace tofmap
