// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "correspondences.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tofmap {
namespace {

/// Variance of a point along a direction, from the standard deviation along its viewing ray.
double variance_along(const SurfacePoint& point, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d ray = point.getVector3fMap().cast<double>().normalized();
  const double sigma = point.sigma_m * ray.dot(direction);
  return sigma * sigma;
}

/// The surface point at the pixel that a point projects into. Null if the point projects outside
/// the image or the pixel has no normal. `point_m` is in the frame of the target's camera.
const SurfacePoint* look_up(const SurfaceCloud& target, const CameraModel& camera,
                            const Eigen::Vector3d& point_m) {
  const std::optional<Eigen::Vector2d> pixel = project(camera, point_m);
  if (!pixel) return nullptr;
  const double u = std::round(pixel->x());
  const double v = std::round(pixel->y());
  if (!(u >= 0 && v >= 0 && u < target.width && v < target.height)) return nullptr;
  const SurfacePoint& found =
      target.points[static_cast<std::size_t>(v) * target.width + static_cast<std::size_t>(u)];
  return found.has_normal() ? &found : nullptr;
}

constexpr std::size_t points_per_block = 512;

/// Limits that a correspondence must keep, and the variance added to each.
struct Gates {
  double max_distance_m;
  double min_normal_cos;
  double systematic_variance_m2;

  explicit Gates(const RegistrationOptions& options)
      : max_distance_m(options.max_correspondence_distance_m),
        min_normal_cos(std::cos(options.max_normal_angle_rad)),
        systematic_variance_m2(options.systematic_sigma_m * options.systematic_sigma_m) {}
};

/// The correspondence of a source point with the target point that it projects onto, in the
/// target's frame. Empty if there is none within the gates.
std::optional<Correspondence> correspondence(const SurfacePoint& source,
                                             const Pose& target_from_source,
                                             const SurfaceCloud& target, const CameraModel& camera,
                                             const Gates& gates) {
  const Eigen::Vector3d point = target_from_source * source.getVector3fMap().cast<double>();
  const SurfacePoint* found = look_up(target, camera, point);
  if (found == nullptr) return std::nullopt;
  const Eigen::Vector3d gap = point - found->getVector3fMap().cast<double>();
  if (gap.squaredNorm() > gates.max_distance_m * gates.max_distance_m) return std::nullopt;

  const Eigen::Vector3d normal = found->getNormalVector3fMap().cast<double>();
  const Eigen::Vector3d source_normal =
      target_from_source.linear() * source.getNormalVector3fMap().cast<double>();
  if (normal.dot(source_normal) < gates.min_normal_cos) return std::nullopt;
  Correspondence pair;
  pair.point_m = point;
  pair.normal = normal;
  pair.source_normal = source_normal;
  pair.residual_m = normal.dot(gap);
  pair.confidence = double{source.confidence} * double{found->confidence};
  const Eigen::Vector3d normal_in_source = target_from_source.linear().transpose() * normal;
  pair.variance_m2 = variance_along(*found, normal) + variance_along(source, normal_in_source) +
                     gates.systematic_variance_m2;
  return pair;
}

/// A target, with poses relative to it and to the world's axes about the source's camera.
struct OrientedTarget {
  const SurfaceCloud* cloud;
  Pose target_from_source;
  Pose local_from_target;
};

std::vector<OrientedTarget> oriented_targets(std::span<const RegistrationTarget> targets,
                                             const Pose& world_from_source) {
  std::vector<OrientedTarget> oriented;
  for (const RegistrationTarget& target : targets) {
    Pose local_from_target = target.world_from_camera;
    local_from_target.translation() -= world_from_source.translation();
    oriented.push_back(
        {target.cloud, target.world_from_camera.inverse() * world_from_source, local_from_target});
  }
  return oriented;
}

/// The correspondences of some of the points.
struct Block {
  std::vector<std::vector<Correspondence>> by_target;
  std::ptrdiff_t matched = 0;  ///< number of points with a correspondence

  Block() = default;

  Block(std::span<const SurfacePoint* const> points, std::span<const OrientedTarget> targets,
        const CameraModel& camera, const Gates& gates)
      : by_target(targets.size()) {
    std::vector<char> is_matched(points.size(), 0);
    for (std::size_t t = 0; t < targets.size(); ++t) {
      const OrientedTarget& target = targets[t];
      by_target[t].reserve(points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        auto pair =
            correspondence(*points[i], target.target_from_source, *target.cloud, camera, gates);
        if (!pair) continue;
        pair->point_m = target.local_from_target * pair->point_m;
        pair->normal = target.local_from_target.linear() * pair->normal;
        pair->source_normal = target.local_from_target.linear() * pair->source_normal;
        by_target[t].push_back(*pair);
        is_matched[i] = 1;
      }
    }
    matched = std::ranges::count(is_matched, 1);
  }
};

Correspondences joined(std::span<const Block> blocks, std::size_t points, std::size_t targets) {
  Correspondences out;
  std::ptrdiff_t matched = 0;
  std::size_t size = 0;
  for (const Block& block : blocks) {
    matched += block.matched;
    for (const auto& pairs : block.by_target) size += pairs.size();
  }
  out.pairs.reserve(size);
  for (std::size_t t = 0; t < targets; ++t) {
    const std::size_t before = out.pairs.size();
    for (const Block& block : blocks) {
      out.pairs.insert(out.pairs.end(), block.by_target[t].begin(), block.by_target[t].end());
    }
    out.of_target.push_back(out.pairs.size() - before);
  }
  if (points > 0) out.overlap = static_cast<double>(matched) / static_cast<double>(points);
  return out;
}

}  // namespace

std::vector<const SurfacePoint*> select_points(const SurfaceCloud& source, int stride_px) {
  std::vector<const SurfacePoint*> points;
  for (std::uint32_t row = 0; row < source.height; row += stride_px) {
    for (std::uint32_t col = 0; col < source.width; col += stride_px) {
      const SurfacePoint& point = source.points[row * source.width + col];
      if (point.has_normal()) points.push_back(&point);
    }
  }
  return points;
}

Correspondences find_correspondences(const std::vector<const SurfacePoint*>& points,
                                     const Pose& world_from_source,
                                     std::span<const RegistrationTarget> targets,
                                     const CameraModel& camera,
                                     const RegistrationOptions& options) {
  const Gates gates(options);
  const std::vector<OrientedTarget> oriented = oriented_targets(targets, world_from_source);
  const std::size_t count = (points.size() + points_per_block - 1) / points_per_block;
  std::vector<Block> blocks(count);
#pragma omp parallel for schedule(static) if (points.size() * targets.size() > enough_for_threads)
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * points_per_block;
    const auto size = std::min(points_per_block, points.size() - first);
    blocks[i] = Block(std::span(points).subspan(first, size), oriented, camera, gates);
  }
  return joined(blocks, points.size(), targets.size());
}

}  // namespace tofmap
