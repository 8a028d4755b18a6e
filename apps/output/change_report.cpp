// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/change_report.hpp"

#include "output/change_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/cloud/change_file.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/visualization/color.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

/// What has become of a point, as a number in the file.
enum class PointKind { gone, appeared, moved_from, moved_to };

Json box_json(const MapCloud& cloud) {
  if (cloud.empty()) return nullptr;
  const Eigen::AlignedBox3f box = box_of(cloud);
  return {{"min_m", {box.min().x(), box.min().y(), box.min().z()}},
          {"max_m", {box.max().x(), box.max().y(), box.max().z()}}};
}

double rotation_rad(const MapChange& change) {
  return Eigen::AngleAxisd(change.after_from_before.linear()).angle();
}

const MapRecording& recording_of(const MapChange& change,
                                 const std::vector<MapRecording>& recordings) {
  return recordings[static_cast<std::size_t>(change.recording)];
}

std::string told(const MapCloud& cloud) {
  const Eigen::Vector3f middle_m = box_of(cloud).center();
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", middle_m.x(), middle_m.y(), middle_m.z());
}

/// Where a change is: "around (1.20, 0.35, 4.10)", or from where to where.
std::string told_place(const MapChange& change) {
  constexpr double degrees = 180 / M_PI;
  if (change.kind == ChangeKind::moved) {
    return fmt::format("from {} to {}, by {:.2f} m and {:.0f} degrees", told(change.before),
                       told(change.after), moved_m(change), degrees * rotation_rad(change));
  }
  return "around " + told(change.kind == ChangeKind::gone ? change.before : change.after);
}

}  // namespace

Json changes_json(const std::vector<MapChange>& changes,
                  const std::vector<MapRecording>& recordings) {
  Json list = Json::array();
  for (const MapChange& change : changes) {
    Json json{{"kind", name_of(change.kind)},
              {"recording", change.recording},
              {"noticed", recording_of(change, recordings).added},
              {"points", point_count(change)},
              {"before", box_json(change.before)},
              {"after", box_json(change.after)}};
    if (change.kind == ChangeKind::moved) {
      json["moved_m"] = moved_m(change);
      json["rotation_rad"] = rotation_rad(change);
    }
    list.push_back(std::move(json));
  }
  return list;
}

void print_changes(const std::vector<MapChange>& changes,
                   const std::vector<MapRecording>& recordings) {
  constexpr std::size_t most_printed = 20;
  for (std::size_t i = 0; i < std::min(most_printed, changes.size()); ++i) {
    const MapChange& change = changes[i];
    std::printf("%s, noticed %s: %s %s\n", std::string(name_of(change.kind)).c_str(),
                recording_of(change, recordings).added.c_str(),
                counted(point_count(change), "point").c_str(), told_place(change).c_str());
  }
  if (changes.size() > most_printed) {
    std::printf("and %zu more changes\n", changes.size() - most_printed);
  }
}

PageTable change_table(const std::vector<MapChange>& changes,
                       const std::vector<MapRecording>& recordings) {
  PageTable table{{"", "noticed", "points", "where, m"}, {}};
  for (const MapChange& change : changes) {
    table.rows.push_back({std::string(name_of(change.kind)), recording_of(change, recordings).added,
                          std::to_string(point_count(change)), told_place(change)});
  }
  return table;
}

void write_changes(const std::filesystem::path& file, const std::vector<MapChange>& changes) {
  pcl::PointCloud<ChangedPoint> points;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const MapChange& change = changes[i];
    const auto add = [&](const MapCloud& cloud, PointKind kind) {
      const Rgb color = color_of(change.kind);
      for (const MapPoint& point : cloud) {
        ChangedPoint changed{};
        changed.getVector4fMap() = point.getVector4fMap();
        changed.getNormalVector4fMap() = point.getNormalVector4fMap();
        changed.r = color.red;
        changed.g = color.green;
        changed.b = color.blue;
        changed.a = std::numeric_limits<std::uint8_t>::max();
        changed.kind = static_cast<std::uint32_t>(kind);
        changed.change = static_cast<std::uint32_t>(i);
        changed.recording = static_cast<std::uint32_t>(change.recording);
        points.push_back(changed);
      }
    };
    const bool has_moved = change.kind == ChangeKind::moved;
    add(change.before, has_moved ? PointKind::moved_from : PointKind::gone);
    add(change.after, has_moved ? PointKind::moved_to : PointKind::appeared);
  }
  write_changed_points(file, points);
}

}  // namespace tofmap::app
