// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/moving_bodies.hpp"

#include "door_sites.hpp"
#include "people.hpp"

#include <algorithm>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// How far from the camera's path people may walk.
double reach_m(const SimulatorOptions& options) {
  constexpr double least_m = 6;
  constexpr double beyond_people_m = 3;
  return std::max(least_m, 2 * options.people_range_m + beyond_people_m);
}

}  // namespace

struct MovingBodies::Plan {
  std::vector<Door> doors;
  std::vector<Walker> people;
};

MovingBodies::MovingBodies(const TriangleMesh& still, const Trajectory& camera_path,
                           const CameraModel& camera, const SimulatorOptions& options)
    : plan_(std::make_unique<Plan>()) {
  if (options.people == 0 && options.doors == 0) return;
  const RayScene rays(still);
  const CameraSteps steps = camera_steps(camera_path);
  StandingSpace space(rays, camera_path, reach_m(options));
  plan_->doors = hang_doors(rays, space, steps, camera, options.doors, options.seed);
  for (const Door& door : plan_->doors) {
    constexpr double person_m = 0.5;
    space.block(door.hinge_m, Door::width_m + person_m);
  }
  plan_->people = walking_people({rays, space, steps, camera}, options);
}

MovingBodies::MovingBodies(MovingBodies&&) noexcept = default;
MovingBodies& MovingBodies::operator=(MovingBodies&&) noexcept = default;
MovingBodies::~MovingBodies() = default;

bool MovingBodies::are_none() const { return plan_->people.empty() && plan_->doors.empty(); }

const std::vector<Door>& MovingBodies::doors() const { return plan_->doors; }

int MovingBodies::people_count() const { return static_cast<int>(plan_->people.size()); }

std::vector<PersonStance> MovingBodies::people_at(double time_s) const {
  std::vector<PersonStance> people;
  for (const Walker& walker : plan_->people) {
    if (const auto stance = walker.stance_at(time_s)) people.push_back(*stance);
  }
  return people;
}

TriangleMesh MovingBodies::surface_at(double time_s) const {
  TriangleMesh mesh;
  for (const Walker& walker : plan_->people) {
    if (const auto stance = walker.stance_at(time_s)) add_person(mesh, walker.look(), *stance);
  }
  for (const Door& door : plan_->doors) add_leaf(mesh, door, time_s);
  return mesh;
}

void MovingBodies::add_frames(TriangleMesh& still) const {
  for (const Door& door : plan_->doors) add_frame(still, door);
}

}  // namespace tofmap
