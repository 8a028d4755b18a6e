// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/moving_bodies.hpp"

#include "people.hpp"

namespace tofmap {

struct MovingBodies::Plan {
  std::vector<Walker> people;
};

MovingBodies::MovingBodies(const RayScene& still, const Trajectory& camera,
                           const SimulatorOptions& options)
    : plan_(std::make_unique<Plan>(Plan{walking_people(still, camera, options)})) {}

MovingBodies::MovingBodies(MovingBodies&&) noexcept = default;
MovingBodies& MovingBodies::operator=(MovingBodies&&) noexcept = default;
MovingBodies::~MovingBodies() = default;

bool MovingBodies::is_none() const { return plan_->people.empty(); }

TriangleMesh MovingBodies::surface_at(double time_s) const {
  TriangleMesh mesh;
  for (const Walker& walker : plan_->people) {
    if (const auto stance = walker.stance_at(time_s)) add_person(mesh, walker.look(), *stance);
  }
  return mesh;
}

}  // namespace tofmap
