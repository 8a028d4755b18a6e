// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <memory>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/door.hpp>
#include <tofmap/simulation/person.hpp>
#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

struct SimulatorOptions;

/// What moves in a simulated scene: people and doors (docs/simulator.md). Where they are at a time
/// depends only on the scene, the path of the camera, and the options. World frame, metres.
class MovingBodies {
 public:
  /// Plans all motion of a recording. `still` is the surface that does not move, and `camera_path`
  /// the poses of the camera at its frames: one or more, with increasing timestamps.
  MovingBodies(const TriangleMesh& still, const Trajectory& camera_path, const CameraModel& camera,
               const SimulatorOptions& options);
  MovingBodies(MovingBodies&&) noexcept;
  MovingBodies& operator=(MovingBodies&&) noexcept;
  ~MovingBodies();

  /// Whether nothing ever moves.
  bool are_none() const;

  /// The doors, fewer than the options ask for if walls lack the space.
  const std::vector<Door>& doors() const;

  /// Number of people, smaller than the options ask for if there is not enough free space.
  int people_count() const;

  /// The postures of the people who are in the scene at a time.
  std::vector<PersonStance> people_at(double time_s) const;

  /// The surface of people and leaves of doors at a time. Empty if nothing is in the scene then.
  TriangleMesh surface_at(double time_s) const;

  /// Adds the frames of the doors, which do not move, to a surface.
  void add_frames(TriangleMesh& still) const;

 private:
  struct Plan;
  std::unique_ptr<Plan> plan_;
};

}  // namespace tofmap
