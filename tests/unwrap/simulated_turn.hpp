// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <tofmap/simulation/simulator.hpp>

namespace tofmap::test {

/// The camera's rotation from one frame to another, a rotation vector in the camera frame of `one`.
inline Eigen::Vector3d turn_between(const SimulatedFrame& one, const SimulatedFrame& other) {
  const Eigen::AngleAxisd turned(
      (one.world_from_camera.inverse() * other.world_from_camera).linear());
  return turned.angle() * turned.axis();
}

}  // namespace tofmap::test
