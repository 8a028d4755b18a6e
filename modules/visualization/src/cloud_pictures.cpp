// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/cloud_pictures.hpp"

#include "picture_gap.hpp"
#include "quantile.hpp"
#include "tofmap/visualization/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

constexpr int panel_width_px = 640;
constexpr int panel_height_px = 480;
constexpr Rgb untouched{60, 90, 130};

/// The field of view of the camera as a pyramid of depth `depth_m` with its tip at the camera.
LineLayer camera_outline(const PixelRays& rays, float depth_m) {
  const Eigen::Index bottom = rays.z.rows() - 1;
  const Eigen::Index right = rays.z.cols() - 1;
  const auto corner = [&](Eigen::Index v, Eigen::Index u) -> Eigen::Vector3f {
    return Eigen::Vector3f(rays.x(v, u), rays.y(v, u), rays.z(v, u)) * (depth_m / rays.z(v, u));
  };
  const Eigen::Vector3f tip = Eigen::Vector3f::Zero();
  const Eigen::Vector3f a = corner(0, 0);
  const Eigen::Vector3f b = corner(0, right);
  const Eigen::Vector3f c = corner(bottom, right);
  const Eigen::Vector3f d = corner(bottom, 0);
  return {{tip, a, b, tip, c, d, tip, a, d, c, b}, colors::black, 1.5F};
}

/// The 99th percentile of the depths, but at least 1 m.
double reach_m(const ImageF& range_m, const PixelRays& rays) {
  constexpr double share = 0.99;
  return std::max(1.0F, finite_quantile(depth_from_range(range_m, rays), share).value_or(1));
}

}  // namespace

Drawing frame_drawing(const ImageF& range_m, const PixelRays& rays,
                      const std::function<Rgb(Eigen::Index row, Eigen::Index col)>& color) {
  PointLayer layer;
  for (Eigen::Index v = 0; v < range_m.rows(); ++v) {
    for (Eigen::Index u = 0; u < range_m.cols(); ++u) {
      if (!std::isfinite(range_m(v, u))) continue;
      layer.points_m.push_back(range_m(v, u) *
                               Eigen::Vector3f(rays.x(v, u), rays.y(v, u), rays.z(v, u)));
      layer.colors.push_back(color(v, u));
    }
  }
  const auto camera_m = static_cast<float>(reach_m(range_m, rays) / 12);
  return {{std::move(layer)}, {camera_outline(rays, camera_m)}, {}};
}

Drawing frame_drawing(const RangeImage& unwrapped, const ImageF& range_m, const PixelRays& rays) {
  const ImageF valid_m = (unwrapped.wrap_count == invalid_wrap_count).select(NAN, range_m);
  return frame_drawing(valid_m, rays, [&](Eigen::Index row, Eigen::Index col) {
    return unwrapped.wrap_count(row, col) > 0 ? colors::corrected : untouched;
  });
}

Viewpoint frame_viewpoint_left(const ImageF& range_m, const PixelRays& rays) {
  const double reach = reach_m(range_m, rays);
  Viewpoint viewpoint;
  viewpoint.eye_m = reach * Eigen::Vector3d(-0.95, -0.45, -0.2);
  viewpoint.target_m = reach * Eigen::Vector3d(0, 0, 0.52);
  viewpoint.vertical_fov_deg = 45;
  return viewpoint;
}

Viewpoint frame_viewpoint_above(const ImageF& range_m, const PixelRays& rays) {
  const double reach = reach_m(range_m, rays);
  Viewpoint viewpoint;
  viewpoint.eye_m = reach * Eigen::Vector3d(0, -3, 0.5);
  viewpoint.target_m = reach * Eigen::Vector3d(0, 0, 0.5);
  viewpoint.up = Eigen::Vector3d::UnitZ();
  viewpoint.parallel_height_m = 1.12 * reach;
  return viewpoint;
}

Picture cloud_picture(const RangeImage& unwrapped, const ImageF& wrapped_m, const PixelRays& rays) {
  const auto row = [&](const ImageF& range_m, const std::string& title) {
    const Drawing drawing = frame_drawing(unwrapped, range_m, rays);
    const auto panel = [&](const Viewpoint& viewpoint, const char* from) {
      return titled(draw(drawing, viewpoint, panel_width_px, panel_height_px), title + from);
    };
    return beside({panel(frame_viewpoint_left(unwrapped.range_m, rays), ", from the left"),
                   panel(frame_viewpoint_above(unwrapped.range_m, rays), ", from above")},
                  picture_gap_px);
  };
  const Picture key =
      color_key({{untouched, "within one wavelength"}, {colors::corrected, "moved by unwrapping"}});
  return with_margin(stacked({row(wrapped_m, "without unwrapping"),
                              row(unwrapped.range_m, "with unwrapping"), key},
                             picture_gap_px),
                     picture_gap_px);
}

}  // namespace tofmap
