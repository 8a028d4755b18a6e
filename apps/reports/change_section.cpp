// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/change_section.hpp"

#include "output/change_drawing.hpp"
#include "output/change_report.hpp"
#include "reports/report_sections.hpp"
#include "views/viewed.hpp"

#include <algorithm>

#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

constexpr int width_px = 900;
constexpr Rgb unchanged{205, 209, 214};

/// The map from above in grey, with what has changed in colour.
Picture picture_of(const MapCloud& surface, const Trajectory& trajectory,
                   const std::vector<MapChange>& changes) {
  const GravityAlignedFrame frame = gravity_aligned_frame(surface, trajectory);
  Drawing drawing = map_drawing(surface, trajectory, frame);
  for (PointLayer& layer : drawing.points) std::ranges::fill(layer.colors, unchanged);
  drawing.lines.clear();
  for (const MapChange& change : changes) {
    add_change(drawing, change, Pose(frame.aligned_from_map));
  }
  Eigen::Vector3d size_m = Eigen::Vector3d::Ones();
  if (!frame.box_m.isEmpty()) size_m = frame.box_m.sizes();
  const int height_px = std::clamp(
      static_cast<int>(width_px * size_m.y() / std::max(size_m.x(), 0.1)), width_px / 4, width_px);
  const double aspect = static_cast<double>(width_px) / height_px;
  return draw(drawing, viewpoint_above(frame.box_m, aspect), width_px, height_px);
}

}  // namespace

void add_changes(ReportPage& page, const MapCloud& surface, const Trajectory& trajectory,
                 const std::vector<MapChange>& changes,
                 const std::vector<MapRecording>& recordings) {
  if (changes.empty()) return;
  page.add_heading("What has changed");
  add_drawn(page, [&] {
    return std::vector<PageFigure>{{picture_of(surface, trajectory, changes),
                                    std::string("the map from above; ") + change_colors_told}};
  });
  page.add_table(change_table(changes, recordings));
}

}  // namespace tofmap::app
