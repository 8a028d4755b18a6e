// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/cloud/cloud_file.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A motion after which one surface looks like another one.
struct MovedShape {
  Pose after_from_before = Pose::Identity();
  double fit = 0;  ///< the smaller share of the points of either surface that lie on the other one
};

/// Searches for a motion along the floor, turns included, that brings a surface to where another
/// one is. Each was seen from other sides, so a part of their points is enough. `up` is the
/// direction that is up. Empty if they do not have the same shape.
std::optional<MovedShape> find_motion(const MapCloud& before, const MapCloud& after,
                                      const Eigen::Vector3d& up, double voxel_m);

}  // namespace tofmap
