// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <tofmap/core/trajectory.hpp>

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

/// What a view shows at the place of a point.
enum class Sight : std::uint8_t {
  nothing,    ///< no surface in that direction, or the point is behind one
  surface,    ///< a surface at the point
  free_space  ///< the view sees through the place of the point: a free-space violation
};

/// What a view shows at the place of each point of a cloud. A point is in free space if it is
/// nearer than the surface in its bin and in the bins around by more than `slack_m` plus 2 % of its
/// range, and on the surface if it differs by no more than that from the surface in its bin.
std::vector<Sight> sights(const SphericalView& view, std::span<const Eigen::Vector3f> points_m,
                          const Pose& view_from_points, double slack_m);

}  // namespace tofmap
