// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/change_drawing.hpp"

#include <utility>

#include <tofmap/visualization/color.hpp>

namespace tofmap::app {

Rgb color_of(ChangeKind kind) {
  switch (kind) {
    case ChangeKind::gone:
      return colors::gone;
    case ChangeKind::appeared:
      return colors::appeared;
    case ChangeKind::moved:
      break;
  }
  return colors::moved;
}

void add_change(Drawing& drawing, const MapChange& change, const Pose& drawing_from_world) {
  const Eigen::Affine3f transform = drawing_from_world.cast<float>();
  for (const MapCloud* cloud : {&change.before, &change.after}) {
    PointLayer layer;
    for (const MapPoint& point : *cloud) {
      layer.points_m.emplace_back(transform * Eigen::Vector3f(point.getVector3fMap()));
      layer.colors.push_back(color_of(change.kind));
    }
    constexpr float dot_px = 4;
    layer.dot_px = dot_px;
    drawing.points.push_back(std::move(layer));
  }
}

}  // namespace tofmap::app
