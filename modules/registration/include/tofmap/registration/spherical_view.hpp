// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/oriented_cloud.hpp>

namespace tofmap {

/// Range image of a cloud seen from a point in all directions: the nearest range in each bin of 1.5
/// degrees of azimuth (about the z axis) and elevation.
class SphericalView {
 public:
  /// `points_m` and the viewpoint `from_m` are in the same frame.
  SphericalView(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& from_m);

  const Eigen::Vector3d& from_m() const { return from_m_; }

  /// Nearest range in the bin that a point falls into. Empty if the cloud has no point in that bin.
  std::optional<double> range_m(const Eigen::Vector3d& point_m) const;

  /// Nearest range in the bin that a point falls into and in the eight bins around it. Empty if the
  /// cloud has no point in the central bin.
  std::optional<double> nearest_range_around_m(const Eigen::Vector3d& point_m) const;

 private:
  static constexpr int azimuths = 240;
  static constexpr int elevations = 120;
  struct Bin {
    int azimuth;
    int elevation;
  };
  Bin bin_of(const Eigen::Vector3d& point_m) const;
  float& at(const Bin& bin);
  float at(const Bin& bin) const;

  Eigen::Vector3d from_m_;
  std::vector<float> nearest_m_;  ///< by elevation, then azimuth; infinite in empty bins
};

/// Whether the cloud could have been seen from a point: less than 10 % of its points are occluded
/// from there, that is, more than 1.2 times as far away as the nearest point of their bin.
bool may_be_viewpoint(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& place_m);

/// Share of free-space violations: of the points of a cloud that lie on or in front of the surface
/// that a view sees, the share in front of it, which the view sees through. A point is in front if
/// it is nearer than the surface in its bin and in the bins around by more than `slack_m` plus 2 %
/// of its range, and on the surface if it differs by no more than that from the surface in its bin.
/// Points behind the surface and points in empty bins are not counted. 0 if no point is counted.
double free_space_violation_share(const SphericalView& view, const OrientedCloud& cloud,
                                  const Pose& view_from_cloud, double slack_m);

}  // namespace tofmap
