// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/map_information.hpp"

#include "output/change_report.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <set>

#include <Eigen/Geometry>

#include <tofmap/core/text.hpp>
#include <tofmap/mapping/map_store.hpp>

namespace tofmap::app {
namespace {

constexpr double bytes_per_megabyte = 1e6;

/// A text from a file, which may be from anyone, without what would control the terminal.
std::string printable(std::string text) {
  std::ranges::replace_if(
      text, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, '?');
  return text;
}

void print_recordings(const MapContent& content) {
  for (int i = 0; i < std::ssize(content.recordings); ++i) {
    const MapRecording& recording = content.recordings[static_cast<std::size_t>(i)];
    const auto frames = std::ranges::count(content.frames, i, &RegisteredFrame::recording);
    const auto keyframes = std::ranges::count(content.keyframes.all(), i, &Keyframe::recording);
    std::printf("recording %d: %s, %s, %s, %s, tofmap %s\n", i,
                recording.source.empty() ? "unknown source" : printable(recording.source).c_str(),
                recording.added.empty() ? "unknown date" : printable(recording.added).c_str(),
                counted(static_cast<std::size_t>(frames), "frame").c_str(),
                counted(static_cast<std::size_t>(keyframes), "keyframe").c_str(),
                printable(recording.version).c_str());
  }
}

void print_camera(const MapContent& content) {
  const CameraModel& camera = content.camera;
  std::printf("camera: %d x %d px, f %.1f x %.1f px\n", camera.width_px, camera.height_px,
              camera.fx_px, camera.fy_px);
}

void print_maps(const MapContent& content) {
  std::set<int> numbers;
  for (const Keyframe& keyframe : content.keyframes.all()) numbers.insert(keyframe.map);
  for (const int number : numbers) {
    const auto keyframes = static_cast<std::size_t>(
        std::ranges::count(content.keyframes.all(), number, &Keyframe::map));
    const MapCloud surface = surface_of(content, number);
    const Eigen::AlignedBox3f box = box_of(surface);
    Eigen::Vector3f size_m = Eigen::Vector3f::Zero();
    if (!box.isEmpty()) size_m = box.sizes();
    std::printf("map %d: %s, %zu points, %.2f x %.2f x %.2f m\n", number,
                counted(keyframes, "keyframe").c_str(), surface.size(), size_m.x(), size_m.y(),
                size_m.z());
  }
  if (numbers.size() > 1) std::printf("  these could not be joined with each other\n");
}

void print_constraints(const MapContent& content) {
  const auto used = std::ranges::count(content.loops, true, &Loop::is_used);
  std::printf("constraints: %zu of odometry, %zu of loops, of which %td are used\n",
              content.edges.size() - content.loops.size(), content.loops.size(), used);
}

}  // namespace

void print_map_information(const std::filesystem::path& file) {
  const MapStore store = MapStore::open(file);
  const MapContent content = store.content();
  std::printf("map file: %s, %.1f MB\n", file.c_str(),
              static_cast<double>(std::filesystem::file_size(file)) / bytes_per_megabyte);
  if (!store.entries("run/").empty()) {
    std::printf("  of a run that was interrupted; 'tofmap map --resume' continues it\n");
  }
  print_recordings(content);
  print_camera(content);
  print_maps(content);
  print_constraints(content);
  std::printf("surface: %s of %.3f m in %s\n", counted(voxel_count(content), "voxel").c_str(),
              content.surface_options.voxel_m, counted(content.submaps.size(), "submap").c_str());
  print_changes(content.changes, content.recordings);
}

}  // namespace tofmap::app
