// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/simulation/triangle_mesh.hpp>

namespace tofmap {

/// How tall a person is, and how bright skin and clothes are (reflectances, 0 … 1).
struct PersonLook {
  double height_m = 1.75;
  double skin = 0.6;
  double hair = 0.15;
  double shirt = 0.5;
  double trousers = 0.2;
  double shoes = 0.1;
};

/// The posture of a person who walks.
struct PersonStance {
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();  ///< on the floor beneath the hips
  double heading_rad = 0;                            ///< of the face, about z; 0: along x
  double gait_rad = 0;   ///< phase of the left leg; a stride is a full turn
  double swing_rad = 0;  ///< largest angle of a thigh from the vertical; 0: stands still
};

/// The length of a stride, two steps, of a person who swings the legs by `max_swing_rad`.
double stride_m(const PersonLook& look);

/// The swing of a person at full walking speed.
inline constexpr double max_swing_rad = 0.42;

/// Adds a person: head, neck, trunk, two arms and two legs of two segments each, hands and feet.
/// The segments of arms and legs are as long as those of Winter, 'Biomechanics and Motor Control of
/// Human Movement' (2009, figure 4.1). The lower foot touches the floor.
void add_person(TriangleMesh& mesh, const PersonLook& look, const PersonStance& stance);

}  // namespace tofmap
