// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/registration/global_alignment.hpp>
#include <tofmap/registration/oriented_cloud.hpp>
#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {

/// A cloud as alignment wants it: about its centre, in metres, from coarse to fine.
struct LevelledCloud {
  Eigen::Vector3d centre_m;            ///< of the levels' frame, in the cloud's
  std::vector<OrientedCloud> levels;   ///< voxels of `voxel_m`, its half and its quarter
  std::vector<PointFeature> features;  ///< of the coarsest level
  std::optional<SphericalView> view;   ///< from where the sensor stood, if that is known
};

/// The size of voxels that leaves some five thousand points of a cloud: enough for features to tell
/// places apart, few enough to compare all with all. In the cloud's own unit.
double feature_voxel(const PointSet& cloud);

/// `unit_m` is the length of the cloud's unit. Levels finer than the points themselves are left
/// out; nothing if there are too few points on surfaces.
std::optional<LevelledCloud> make_levels(const PointSet& cloud, double unit_m, double voxel_m);

}  // namespace tofmap
