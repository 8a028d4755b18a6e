// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "keyframe_view.hpp"

#include "tofmap/mapping/moving_regions.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {

KeyframeView::KeyframeView(const RegistrationTarget& seen, const CameraModel& camera,
                           double margin_m, const PoseSpread& spread)
    : camera_from_world_(seen.world_from_camera.inverse()),
      cloud_(*seen.cloud),
      camera_(camera),
      margin_m_(margin_m),
      pose_sigma_m_(spread.translation_sigma_m()),
      pose_sigma_rad_(spread.rotation_sigma_rad()) {
  for (const SurfacePoint& point : cloud_.points) {
    if (point.has_position()) farthest_m_ = std::max(farthest_m_, point.z);
  }
}

Observation KeyframeView::judge(const Eigen::Vector3d& world_m) const {
  const Eigen::Vector3d point_m = camera_from_world_ * world_m;
  if (point_m.z() <= 0 || point_m.z() > farthest_m_ + margin_m_) return Observation::nothing;
  const std::optional<Eigen::Vector2d> pixel = project(camera_, point_m);
  if (!pixel) return Observation::nothing;
  const double u = std::round(pixel->x());
  const double v = std::round(pixel->y());
  if (!(u >= 1 && v >= 1 && u + 1 < cloud_.width && v + 1 < cloud_.height)) {
    return Observation::nothing;
  }
  const int col = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const Eigen::Vector3f at_m = point_m.cast<float>();
  const std::optional<float> before = share_before(row, col, at_m);
  if (!before) return Observation::nothing;
  // On the surface or occluded. A surface of unknown direction agrees with none.
  if (*before <= 1) {
    const bool agrees = *before >= -1 && cloud_.at(col, row).has_normal();
    return agrees ? Observation::agrees : Observation::nothing;
  }
  return is_free_around(row, col, at_m) ? Observation::sees_through : Observation::nothing;
}

/// Whether a point is in front of what is seen at a pixel and at those around it. At the outline of
/// an object, a small error of the pose makes a point project onto the background: so one pixel
/// that does not see through the point decides, and at least two thirds of the pixels must do so.
bool KeyframeView::is_free_around(int row, int col, const Eigen::Vector3f& point_m) const {
  constexpr int least_pixels = 6;
  int seen_through = 0;
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = col - 1; c <= col + 1; ++c) {
      const std::optional<float> before = share_before(r, c, point_m);
      if (!before) continue;
      if (*before <= 1) return false;
      ++seen_through;
    }
  }
  return seen_through >= least_pixels;
}

/// Distance of a point in front of the surface at a pixel, divided by the tolerance; negative if
/// the point is behind the surface. Along the ray if the pixel has no normal. Empty if the pixel
/// has no range, or one whose wrap count is too uncertain to say that the space before it is free.
std::optional<float> KeyframeView::share_before(int row, int col,
                                                const Eigen::Vector3f& point_m) const {
  const SurfacePoint& surface = cloud_.at(col, row);
  if (!surface.has_position()) return std::nullopt;
  const Eigen::Vector3f at_m = surface.getVector3fMap();
  if (!surface.has_normal()) {
    const float share = (at_m.norm() - point_m.norm()) / tolerated_m(surface.sigma_m, point_m);
    const bool is_free = moves(surface) || surface.confidence >= sure_confidence;
    return share <= 1 || is_free ? std::optional(share) : std::nullopt;
  }
  const Eigen::Vector3f normal = surface.getNormalVector3fMap();
  const float sigma_m = surface.sigma_m * std::abs(normal.dot(at_m.normalized()));
  return normal.dot(point_m - at_m) / tolerated_m(sigma_m, point_m);
}

/// The largest distance of a point from a surface, with this standard deviation of its range, at
/// which both may be the same.
float KeyframeView::tolerated_m(double sigma_m, const Eigen::Vector3f& point_m) const {
  constexpr double sigmas = 3;
  const double by_pose_m = std::hypot(pose_sigma_m_, pose_sigma_rad_ * point_m.norm());
  return static_cast<float>(margin_m_ + sigmas * (sigma_m + by_pose_m));
}

}  // namespace tofmap
