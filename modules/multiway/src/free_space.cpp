// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "free_space.hpp"

#include "window.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tofmap {
namespace {

/// A point this far in front of a surface is not on it.
constexpr double in_front_voxels = 1;

/// Of the up to 24 neighbours on a plane. At the edge of a region, half of them are in it; a line
/// of points in free space, as along the edge of a table, has at most four.
constexpr int least_alike_neighbours = 4;

/// Fewer points than this are too little evidence: they are two or three regions of neighbours.
constexpr int least_points = 12;

/// Rooms with more of their visible surfaces in windows are rare.
constexpr double most_in_windows = 0.1;

/// The frame of a window is at most this far from the parts of the pane that are in free space: the
/// bins of a view that touch the frame show its range. Of the range.
constexpr double frame_reach_share = 0.06;
constexpr double frame_reach_voxels = 2;

/// Whether each point is within a region of free space.
std::vector<bool> within_regions(const VoxelNeighbours& neighbours,
                                 const std::vector<Sight>& sights) {
  std::vector<bool> is_within(sights.size());
  for (std::size_t i = 0; i < sights.size(); ++i) {
    if (sights[i] != Sight::free_space) continue;
    int alike = 0;
    int on_surface = 0;
    for (const int other : neighbours.of(i)) {
      alike += sights[static_cast<std::size_t>(other)] == Sight::free_space ? 1 : 0;
      on_surface += sights[static_cast<std::size_t>(other)] == Sight::surface ? 1 : 0;
    }
    is_within[i] = alike >= least_alike_neighbours && alike >= on_surface;
  }
  return is_within;
}

/// Connected regions of free space around the points within regions, with their edges.
std::vector<std::vector<int>> regions_of(const VoxelNeighbours& neighbours,
                                         const std::vector<Sight>& sights,
                                         const std::vector<bool>& is_within) {
  std::vector<std::vector<int>> regions;
  std::vector<bool> is_known(sights.size());
  for (std::size_t first = 0; first < sights.size(); ++first) {
    if (!is_within[first] || is_known[first]) continue;
    std::vector<int> region{static_cast<int>(first)};
    is_known[first] = true;
    for (std::size_t done = 0; done < region.size(); ++done) {
      const auto at = static_cast<std::size_t>(region[done]);
      if (!is_within[at]) continue;  // an edge
      for (const int other : neighbours.of(at)) {
        const auto next = static_cast<std::size_t>(other);
        if (is_known[next] || sights[next] != Sight::free_space) continue;
        is_known[next] = true;
        region.push_back(other);
      }
    }
    regions.push_back(std::move(region));
  }
  return regions;
}

double mean_range_m(const SphericalView& view, const OrientedCloud& cloud,
                    const std::vector<int>& region, const Pose& view_from_cloud) {
  double sum_m = 0;
  for (const int i : region) {
    sum_m += (view_from_cloud * cloud.points_m[i].cast<double>() - view.from_m()).norm();
  }
  return sum_m / static_cast<double>(region.size());
}

}  // namespace

double FreeSpaceEvidence::violation_share() const {
  if (in_free_space < least_points) return 0;
  return static_cast<double>(in_free_space) / (in_free_space + on_surface);
}

double FreeSpaceEvidence::window_share() const {
  const int all = on_surface + in_free_space + in_windows;
  return all > 0 ? static_cast<double>(in_windows) / all : 0;
}

FreeSpaceEvidence free_space_evidence(const SphericalView& view, const LevelledCloud& cloud,
                                      const Pose& view_from_cloud) {
  const OrientedCloud& points = cloud.levels.front();
  const std::vector<Sight> found =
      sights(view, points.points_m, view_from_cloud, in_front_voxels * points.voxel_m);
  const std::vector<bool> is_within = within_regions(cloud.neighbours, found);
  FreeSpaceEvidence evidence;
  evidence.on_surface = static_cast<int>(std::ranges::count(found, Sight::surface));
  for (const std::vector<int>& region : regions_of(cloud.neighbours, found, is_within)) {
    const double reach_m = frame_reach_voxels * points.voxel_m +
                           frame_reach_share * mean_range_m(view, points, region, view_from_cloud);
    const auto within = static_cast<int>(std::ranges::count_if(
        region, [&](int i) { return is_within[static_cast<std::size_t>(i)]; }));
    const bool is_window = may_be_window(points, region, found, reach_m);
    (is_window ? evidence.in_windows : evidence.in_free_space) += within;
  }
  const int all = evidence.on_surface + evidence.in_free_space + evidence.in_windows;
  if (evidence.in_windows > most_in_windows * all) {
    evidence.in_free_space += std::exchange(evidence.in_windows, 0);
  }
  return evidence;
}

FreeSpaceEvidence least_evidence(std::span<const SphericalView> views, const LevelledCloud& cloud,
                                 const Pose& view_from_cloud) {
  std::vector<FreeSpaceEvidence> all;
  for (const SphericalView& view : views) {
    all.push_back(free_space_evidence(view, cloud, view_from_cloud));
  }
  if (all.empty()) return {};
  return *std::ranges::min_element(all, {}, &FreeSpaceEvidence::violation_share);
}

}  // namespace tofmap
