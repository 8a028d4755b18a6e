// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "keyframe_view.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {

KeyframeView::KeyframeView(const RegistrationTarget& seen, const CameraModel& camera,
                           double margin_m)
    : camera_from_world_(seen.world_from_camera.inverse()),
      cloud_(*seen.cloud),
      camera_(camera),
      margin_m_(margin_m) {
  for (const SurfacePoint& point : cloud_.points) {
    if (point.has_normal()) farthest_m_ = std::max(farthest_m_, point.z);
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
  if (std::abs(*before) <= 1) return Observation::agrees;
  if (*before < 0) return Observation::nothing;  // the point is occluded
  // At the outline of an object, a small error of the pose makes a point project onto the
  // background. So the point must be in front of the surfaces around as well.
  for (int r = row - 1; r <= row + 1; ++r) {
    for (int c = col - 1; c <= col + 1; ++c) {
      const std::optional<float> beside = share_before(r, c, at_m);
      if (!beside || *beside <= 1) return Observation::nothing;
    }
  }
  return Observation::sees_through;
}

/// Distance of a point in front of the surface at a pixel, divided by the tolerance; negative if
/// the point is behind the surface. Empty if the pixel has no surface.
std::optional<float> KeyframeView::share_before(int row, int col,
                                                const Eigen::Vector3f& point_m) const {
  constexpr float sigmas = 3;
  const SurfacePoint& surface = cloud_.at(col, row);
  if (!surface.has_normal()) return std::nullopt;
  const Eigen::Vector3f normal = surface.getNormalVector3fMap();
  const Eigen::Vector3f at_m = surface.getVector3fMap();
  const float sigma_m = surface.sigma_m * std::abs(normal.dot(at_m.normalized()));
  const float tolerated_m = static_cast<float>(margin_m_) + sigmas * sigma_m;
  return normal.dot(point_m - at_m) / tolerated_m;
}

}  // namespace tofmap
