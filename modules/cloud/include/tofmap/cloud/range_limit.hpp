// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace tofmap {

/// The limit of a sensor's range, at which some sensors write a point for each ray without a
/// return. Such points are no surface: they lie on a sphere about the sensor, in whatever place it
/// stands. All values are in the frame and the unit of the cloud.
struct RangeLimit {
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();  ///< centre of the sphere
  double range = 0;                                  ///< radius of the sphere
  std::size_t points = 0;                            ///< number of points on the sphere
};

/// Finds points at a constant greatest range from a sensor. Empty if there are none.
///
/// Points are on the sphere if their range differs by at most 0.1 % from the limit. They count as
/// points without a return if
///  - there are at least 30 of them, and at least 0.1 % of the cloud;
///  - hardly any points (0.05 %) are farther away;
///  - there are at least four times as many of them, on average, as of points in the two bands of
///    ranges of the same width just before them. Near the greatest range of a real surface, which
///    is an edge or a corner of it, points become fewer;
///  - their ranges are much more alike than those of planes in the same directions would be, one
///    plane in each octant.
/// Walls across the ends of a corridor fulfil all but the last condition. The inside of a ball
/// around the sensor cannot be told from a limit.
std::optional<RangeLimit> find_range_limit(std::span<const Eigen::Vector3d> points,
                                           const Eigen::Vector3d& sensor);

/// Finds points at a constant greatest range from a sensor whose position is unknown, by fitting a
/// sphere to the outermost points. The conditions are those above, and the sensor must be within
/// the bounding box of the points, or outside by at most a tenth of its diagonal.
std::optional<RangeLimit> find_range_limit(std::span<const Eigen::Vector3d> points);

/// Removes the points at a limit. Returns the number of removed points.
std::size_t remove_range_limit(std::vector<Eigen::Vector3d>& points, const RangeLimit& limit);

}  // namespace tofmap
