// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "voxel_neighbours.hpp"

#include <optional>
#include <vector>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/multiway/cloud_sensor.hpp>
#include <tofmap/registration/global_alignment.hpp>
#include <tofmap/registration/oriented_cloud.hpp>
#include <tofmap/registration/spherical_view.hpp>

namespace tofmap {

/// A cloud prepared for registration: centred, in metres, as a pyramid from coarse to fine.
struct LevelledCloud {
  Eigen::Vector3d centre_m;            ///< mean of the points: origin of the centred frame
  std::vector<OrientedCloud> levels;   ///< voxels of `voxel_m`, of half and of a quarter of it
  std::vector<PointFeature> features;  ///< of the coarsest level
  VoxelNeighbours neighbours;          ///< of the coarsest level
  /// From the position of the sensor. From all possible places (possible_views()) if it is unknown.
  std::vector<SphericalView> views;
};

/// The voxel size that leaves about 5000 points of a cloud, or half of the points if they are fewer
/// than 10 000, in the unit of the cloud. That is enough for distinctive features, and few enough
/// to compare all pairs of matches.
double feature_voxel(const PointSet& cloud);

/// The voxel size that would leave 5000 points if the surfaces of a cloud were sampled densely, in
/// the unit of the cloud: a measure of their extent. `voxel` is feature_voxel().
double extent_voxel(const PointSet& cloud, double voxel);

/// Builds the levels of a cloud. `sensor` is in the frame and the unit of the cloud; `unit_m` is
/// the unit of length of the cloud, metres; `voxel_m` the voxel size of the coarsest level. Levels
/// finer than the spacing of the points are omitted. Empty if orient() finds too few points with
/// normals on the coarsest level.
std::optional<LevelledCloud> make_levels(const PointSet& cloud, const CloudSensor& sensor,
                                         double unit_m, double voxel_m);

}  // namespace tofmap
