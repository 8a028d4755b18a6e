// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/map_summary.hpp"

#include "output/coverage.hpp"
#include "output/frame_report.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

void print_separate_maps(const RoomMap& map, const std::filesystem::path& folder) {
  if (map.separate_maps.empty()) return;
  constexpr std::size_t most_named = 5;
  const std::size_t count = map.separate_maps.size();
  std::printf("tracking was lost, and %s could not be joined with map.ply:\n",
              counted(count, "separate map").c_str());
  for (std::size_t i = 0; i < std::min(count, most_named); ++i) {
    std::printf("  %s: %s (%s), begun %s\n", files_of_separate_map(i).map.c_str(),
                counted(map.separate_maps[i].trajectory.size(), "frame").c_str(),
                told_extent(map, i).c_str(), told_beginning(map, i).c_str());
  }
  if (count > most_named) std::printf("  and %zu more; see report.html\n", count - most_named);
  if (map.surface.empty() || map.separate_maps.front().surface.empty()) return;
  std::printf("  to join maps that show the same place, try: tofmap register %s %s --out DIR\n",
              (folder / "map.ply").c_str(), (folder / files_of_separate_map(0).map).c_str());
}

}  // namespace

void print_summary(const RoomMap& map, const std::filesystem::path& folder) {
  std::printf("%zu of %zu frames registered, %s, %zu map points\n", map.trajectory.size(),
              map.frames.size(), counted(map.keyframes.size(), "keyframe").c_str(),
              map.surface.size());
  print_separate_maps(map, folder);
  for (const AbsentFrames& absent : absent_frames(map)) {
    std::printf("%s in no map, %s: %s\n", counted(absent.indices.size(), "frame").c_str(),
                absent.why.c_str(), told_indices(absent.indices).c_str());
  }
  for (const std::string& remark : remarks_about(map.errors)) std::printf("%s\n", remark.c_str());
  const bool has_mesh = std::filesystem::exists(folder / "mesh.ply");
  std::printf("map: %s%s\n", (folder / "map.ply").c_str(), has_mesh ? ", mesh beside it" : "");
}

}  // namespace tofmap::app
