// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/coverage_section.hpp"

#include "output/coverage.hpp"
#include "reports/report_sections.hpp"

#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>
#include <tofmap/visualization/map_pictures.hpp>

namespace tofmap::app {
namespace {

constexpr int picture_width_px = 600;

PageFigure figure_of(const RoomMap& map, std::size_t index) {
  const SeparateMap& one = map.separate_maps[index];
  const GravityAlignedFrame frame = gravity_aligned_frame(one.surface, one.trajectory);
  return {map_from_above(one.surface, one.trajectory, frame, color_by_height(one.surface, frame),
                         picture_width_px),
          files_of_separate_map(index).map + ", coloured by height"};
}

void add_separate_maps(ReportPage& page, const RoomMap& map) {
  if (map.separate_maps.empty()) return;
  page.add_heading("Separate maps");
  page.add_text(
      "Tracking was lost, and these maps could not be joined with map.ply, which has the " +
      counted(map.trajectory.size(), "frame") + " " + told_indices(map.frames_in(1)) +
      ". If two maps show the same place, 'tofmap register' may join them: it takes the PLY "
      "files.");
  PageTable table{{"", "frames", "which", "it began"}, {}};
  for (std::size_t i = 0; i < map.separate_maps.size(); ++i) {
    table.rows.push_back({files_of_separate_map(i).map,
                          std::to_string(map.separate_maps[i].trajectory.size()),
                          told_extent(map, i), told_beginning(map, i)});
  }
  page.add_table(table);
  add_drawn(page, [&] {
    std::vector<PageFigure> figures;
    for (std::size_t i = 0; i < map.separate_maps.size(); ++i) {
      if (!map.separate_maps[i].surface.empty()) figures.push_back(figure_of(map, i));
    }
    return figures;
  });
}

void add_absent_frames(ReportPage& page, const RoomMap& map) {
  const std::vector<AbsentFrames> absent = absent_frames(map);
  if (absent.empty()) return;
  page.add_heading("Frames in no map");
  PageTable table{{"why", "number", "which", "what helps"}, {}};
  for (const AbsentFrames& frames : absent) {
    table.rows.push_back({frames.why, std::to_string(frames.indices.size()),
                          told_indices(frames.indices), frames.remedy});
  }
  page.add_table(table);
  std::string damages;
  for (const FrameRecord& record : map.frames) {
    if (!record.damage.empty()) damages += fmt::format("{}: {}\n", record.index, record.damage);
  }
  if (!damages.empty()) page.add_folded("Damaged frames", damages);
}

}  // namespace

void add_coverage(ReportPage& page, const RoomMap& map) {
  add_separate_maps(page, map);
  add_absent_frames(page, map);
}

}  // namespace tofmap::app
