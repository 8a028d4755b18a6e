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

/// A cloud as it is seen from a place: the nearest range in each direction, by bins of a degree and
/// a half in azimuth and elevation.
class SphericalView {
 public:
  SphericalView(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& from_m);

  const Eigen::Vector3d& from_m() const { return from_m_; }

  /// Nearest range where a point is seen; nothing if nothing is seen there.
  std::optional<double> range_m(const Eigen::Vector3d& point_m) const;

  /// As `range_m`, but the nearest of that bin and those around it.
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
  std::vector<float> nearest_m_;  ///< infinite where nothing is seen
};

/// Whether all points could have been seen from there: hardly any direction holds points at
/// different ranges.
bool may_be_viewpoint(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& place_m);

/// Share of the points, of those where the view holds a surface at all, that stand in front of it,
/// by more than `slack_m` and a fiftieth of the range: the view has looked through them, so they
/// are not there. 0 if no point is where the view looks or behind it.
double free_space_violation_share(const SphericalView& view, const OrientedCloud& cloud,
                                  const Pose& view_from_cloud, double slack_m);

}  // namespace tofmap
