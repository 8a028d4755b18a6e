// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/ray_scene.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

struct SimulatorOptions;

/// What moves in a simulated scene: people (docs/simulator.md). Where they are at a time depends
/// only on the scene, the poses of the camera, and the options. World frame, metres.
class MovingBodies {
 public:
  /// Plans all motion of a recording. `still` is the surface that does not move, and `camera` are
  /// the poses of the camera, of which there must be at least one, with increasing timestamps.
  MovingBodies(const RayScene& still, const Trajectory& camera, const SimulatorOptions& options);
  MovingBodies(MovingBodies&&) noexcept;
  MovingBodies& operator=(MovingBodies&&) noexcept;
  ~MovingBodies();

  /// Whether the options ask for nothing that moves.
  bool is_none() const;

  /// The surface of all that moves, as it is at a time. Empty if nothing is in the scene then.
  TriangleMesh surface_at(double time_s) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofmap
