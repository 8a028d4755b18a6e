// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/cloud/range_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Largest relative difference of a range from the limit. Files that are rounded to centimetres, or
/// were downsampled, keep the limit within this.
constexpr double band = 1e-3;

/// Points just before the limit are counted from the inner border of its band to this many times
/// its width.
constexpr double bands_before = 5;

constexpr std::size_t least_points = 30;
constexpr double least_share = 1e-3;
constexpr double most_beyond_share = 5e-4;

/// Least number of points at the limit, in a band of twice `band`, over the number in the two such
/// bands before it. Of a real surface, the outermost band holds at most half as many as those.
constexpr double least_times_before = 2;

/// Largest median deviation of the ranges, relative to that of planes in the same directions.
constexpr double most_of_planes = 0.1;

/// How far outside of the bounding box a searched sensor may be, relative to the diagonal: a camera
/// stands a little before what it sees.
constexpr double most_outside = 0.1;

/// A sphere.
struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;

  /// How far a point lies from the surface, relative to the radius; positive inside.
  double depth(const Eigen::Vector3d& point) const { return 1 - (point - centre).norm() / radius; }
};

/// Ranges from a sensor.
std::vector<double> ranges_from(std::span<const Eigen::Vector3d> points,
                                const Eigen::Vector3d& sensor) {
  std::vector<double> ranges(points.size());
  std::ranges::transform(points, ranges.begin(),
                         [&](const auto& point) { return (point - sensor).norm(); });
  return ranges;
}

/// The median of the ranges around the greatest one, apart from a few strays.
double greatest_range(const std::vector<double>& ranges) {
  std::vector<double> sorted = ranges;
  const auto beyond =
      static_cast<std::ptrdiff_t>(most_beyond_share * static_cast<double>(ranges.size()));
  const auto at = sorted.end() - 1 - beyond;
  std::ranges::nth_element(sorted, at);
  const double first = *at;
  std::erase_if(sorted, [&](double range) { return std::abs(range - first) > band * first; });
  return median(sorted);
}

/// The points on a sphere, and those just inside and outside of it.
struct Shell {
  std::size_t on = 0;
  std::size_t before = 0;
  std::size_t beyond = 0;
  std::vector<double> deviations;             ///< relative, of points on it
  std::array<Eigen::Vector3d, 8> directions;  ///< sums of their directions in each octant

  Shell() { directions.fill(Eigen::Vector3d::Zero()); }

  /// Mean deviation that ranges would have if the points in each octant lay on a plane that faces
  /// the centre: range varies by 1 / cos of the angle from the normal. The walls at both ends of a
  /// corridor are in different octants.
  double deviation_of_planes() const {
    double sum = 0;
    for (const Eigen::Vector3d& octant : directions) sum += octant.norm();
    return 1 - sum / static_cast<double>(on);
  }
};

std::size_t octant_of(const Eigen::Vector3d& direction) {
  return (direction.x() < 0 ? 1U : 0U) + (direction.y() < 0 ? 2U : 0U) +
         (direction.z() < 0 ? 4U : 0U);
}

Shell shell_of(std::span<const Eigen::Vector3d> points, const std::vector<double>& ranges,
               const Sphere& sphere) {
  Shell shell;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double depth = 1 - ranges[i] / sphere.radius;
    if (depth < -band) ++shell.beyond;
    if (depth > band && depth <= bands_before * band) ++shell.before;
    if (std::abs(depth) > band) continue;
    ++shell.on;
    shell.deviations.push_back(std::abs(depth));
    const Eigen::Vector3d direction = (points[i] - sphere.centre) / ranges[i];
    shell.directions[octant_of(direction)] += direction;
  }
  return shell;
}

bool is_limit(Shell shell, std::size_t cloud_size) {
  const auto on = static_cast<double>(shell.on);
  const auto size = static_cast<double>(cloud_size);
  if (shell.on < least_points || on < least_share * size) return false;
  if (static_cast<double>(shell.beyond) > most_beyond_share * size) return false;
  if (on < least_times_before * static_cast<double>(shell.before)) return false;
  return median(shell.deviations) < most_of_planes * shell.deviation_of_planes();
}

/// At most `count` points, at even intervals.
std::vector<Eigen::Vector3d> thinned(std::span<const Eigen::Vector3d> points, std::size_t count) {
  const std::size_t kept = std::min(points.size(), count);
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < kept; ++i) out.push_back(points[i * points.size() / kept]);
  return out;
}

/// The outermost point in each of many directions, which are spread evenly over the sphere
/// (Fibonacci lattice).
std::vector<Eigen::Vector3d> outermost(const std::vector<Eigen::Vector3d>& points) {
  constexpr int directions = 400;
  std::vector<std::size_t> indices;
  for (int i = 0; i < directions; ++i) {
    const double z = 1 - (2 * i + 1.0) / directions;
    const double azimuth = 2 * std::numbers::pi * std::numbers::phi * i;
    const double across = std::sqrt(1 - z * z);
    const Eigen::Vector3d direction(across * std::cos(azimuth), across * std::sin(azimuth), z);
    const auto farthest = std::ranges::max_element(
        points, std::ranges::less(), [&](const auto& point) { return direction.dot(point); });
    indices.push_back(static_cast<std::size_t>(farthest - points.begin()));
  }
  std::ranges::sort(indices);
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Eigen::Vector3d> out;
  for (const std::size_t index : indices) out.push_back(points[index]);
  return out;
}

/// The sphere |p|² = 2 cᵀp + k that fits points best, where k = r² − |c|².
Sphere fitted(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) middle += point;
  middle /= static_cast<double>(points.size());
  Eigen::MatrixX4d factors(points.size(), 4);
  Eigen::VectorXd squares(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d point = points[i] - middle;
    const auto row = static_cast<Eigen::Index>(i);
    factors.row(row) << 2 * point.transpose(), 1;
    squares[row] = point.squaredNorm();
  }
  const Eigen::Vector4d solution = factors.colPivHouseholderQr().solve(squares);
  const Eigen::Vector3d centre = solution.head<3>();
  return {middle + centre, std::sqrt(std::max(0.0, solution[3] + centre.squaredNorm()))};
}

Eigen::AlignedBox3d box_of(std::span<const Eigen::Vector3d> points) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  return box;
}

/// Drops the innermost of the outermost points until a sphere fits the others. Empty if none does.
std::optional<Sphere> enclosing_sphere(std::vector<Eigen::Vector3d> points) {
  constexpr std::size_t least = 12;
  constexpr std::size_t one_in = 10;
  while (points.size() >= least) {
    const Sphere sphere = fitted(points);
    if (!(sphere.radius > 0)) return std::nullopt;
    const auto by_depth = [&](const auto& point) { return sphere.depth(point); };
    std::ranges::sort(points, std::ranges::less(), by_depth);
    if (std::max(-by_depth(points.front()), by_depth(points.back())) < band) return sphere;
    points.resize(points.size() - std::max<std::size_t>(1, points.size() / one_in));
  }
  return std::nullopt;
}

}  // namespace

std::optional<RangeLimit> find_range_limit(std::span<const Eigen::Vector3d> points,
                                           const Eigen::Vector3d& sensor) {
  if (points.size() < least_points) return std::nullopt;
  const std::vector<double> ranges = ranges_from(points, sensor);
  const Sphere sphere{sensor, greatest_range(ranges)};
  if (!(sphere.radius > 0)) return std::nullopt;
  const Shell shell = shell_of(points, ranges, sphere);
  if (!is_limit(shell, points.size())) return std::nullopt;
  return RangeLimit{sensor, sphere.radius, shell.on};
}

std::optional<RangeLimit> find_range_limit(std::span<const Eigen::Vector3d> points) {
  constexpr std::size_t enough_points = 100000;
  if (points.size() < least_points) return std::nullopt;
  const auto rough = enclosing_sphere(outermost(thinned(points, enough_points)));
  if (!rough) return std::nullopt;
  std::vector<Eigen::Vector3d> on_sphere;
  for (const Eigen::Vector3d& point : points) {
    if (std::abs(rough->depth(point)) <= band) on_sphere.push_back(point);
  }
  if (on_sphere.size() < least_points) return std::nullopt;
  const Eigen::Vector3d centre = fitted(on_sphere).centre;
  // A large sphere about a far place fits any wall.
  const Eigen::AlignedBox3d box = box_of(points);
  if (box.exteriorDistance(centre) > most_outside * box.diagonal().norm()) return std::nullopt;
  return find_range_limit(points, centre);
}

std::size_t remove_range_limit(std::vector<Eigen::Vector3d>& points, const RangeLimit& limit) {
  const Sphere sphere{limit.sensor, limit.range};
  return std::erase_if(points,
                       [&](const auto& point) { return std::abs(sphere.depth(point)) <= band; });
}

}  // namespace tofmap
