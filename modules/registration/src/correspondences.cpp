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

constexpr int least_points_for_threads = 4000;

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
  const Eigen::Vector3d origin = world_from_source.translation();
  std::vector<Pose> targets_from_source;
  for (const RegistrationTarget& target : targets) {
    targets_from_source.push_back(target.world_from_camera.inverse() * world_from_source);
  }
  std::vector<std::optional<Correspondence>> found(points.size() * targets.size());
  const int count = static_cast<int>(found.size());
  // With few points, synchronising threads costs more than it saves.
#pragma omp parallel for schedule(static) if (count > least_points_for_threads)
  for (int i = 0; i < count; ++i) {
    const std::size_t t = static_cast<std::size_t>(i) / points.size();
    const std::size_t p = static_cast<std::size_t>(i) % points.size();
    auto pair =
        correspondence(*points[p], targets_from_source[t], *targets[t].cloud, camera, gates);
    if (!pair) continue;
    const Pose& world_from_target = targets[t].world_from_camera;
    pair->point_m = world_from_target * pair->point_m - origin;
    pair->normal = world_from_target.linear() * pair->normal;
    pair->source_normal = world_from_target.linear() * pair->source_normal;
    found[i] = pair;
  }
  Correspondences out;
  out.of_target.assign(targets.size(), 0);
  std::vector<bool> is_matched(points.size(), false);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!found[i]) continue;
    out.pairs.push_back(*found[i]);
    ++out.of_target[i / points.size()];
    is_matched[i % points.size()] = true;
  }
  const auto matched = static_cast<double>(std::ranges::count(is_matched, true));
  if (!points.empty()) out.overlap = matched / static_cast<double>(points.size());
  return out;
}

}  // namespace tofmap
