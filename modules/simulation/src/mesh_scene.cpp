// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <queue>

#include <tofmap/simulation/ray_scene.hpp>
#include <tofmap/simulation/scenes.hpp>

namespace tofmap {
namespace {

using Eigen::Vector2i;
using Eigen::Vector3d;

constexpr double eye_height_m = 1.4;
constexpr double wanted_clearance_m = 0.55;   // the spline cuts corners, up to half of it
constexpr double max_written_range_m = 65.5;  // truth images hold millimetres in 16 bits

/// A horizontal grid at eye height. For each cell, it stores the distance from the centre of the
/// cell to the surface, or 0 where the camera cannot stand.
class FloorPlan {
 public:
  FloorPlan(const RayScene& rays, const Eigen::AlignedBox3d& box)
      : origin_(box.min()), cell_m_(std::clamp(box.sizes().head<2>().maxCoeff() / 80, 0.05, 0.5)) {
    cols_ = static_cast<int>(box.sizes().x() / cell_m_) + 1;
    rows_ = static_cast<int>(box.sizes().y() / cell_m_) + 1;
    origin_.z() += std::min(eye_height_m, box.sizes().z() / 2);
    clearance_.assign(static_cast<std::size_t>(rows_) * cols_, 0);
    const double reach_m = box.sizes().norm();
    for (int i = 0; i < rows_ * cols_; ++i) {
      const Vector3d place = middle(i);
      const double clearance_m = rays.clearance_m(place, 1.5);
      if (clearance_m >= wanted_clearance_m && is_inside(rays, place, reach_m)) {
        clearance_[static_cast<std::size_t>(i)] = clearance_m;
      }
    }
    keep_largest_part();
  }

  int size() const { return rows_ * cols_; }
  bool is_free(int cell) const { return clearance_[static_cast<std::size_t>(cell)] > 0; }
  bool has_space() const {
    return std::ranges::any_of(clearance_, [](double clearance_m) { return clearance_m > 0; });
  }
  double clearance_m(int cell) const { return clearance_[static_cast<std::size_t>(cell)]; }
  double cell_m() const { return cell_m_; }

  Vector3d middle(int cell) const {
    const int row = cell / cols_;
    return origin_ + cell_m_ * Vector3d(cell % cols_ + 0.5, row + 0.5, 0);
  }

  std::vector<int> free_neighbours(int cell) const {
    std::vector<int> cells;
    for (const Vector2i& step :
         {Vector2i(1, 0), Vector2i(0, 1), Vector2i(-1, 0), Vector2i(0, -1)}) {
      const int col = cell % cols_ + step.x();
      const int row = cell / cols_ + step.y();
      const bool on_grid = col >= 0 && col < cols_ && row >= 0 && row < rows_;
      if (on_grid && is_free(row * cols_ + col)) cells.push_back(row * cols_ + col);
    }
    return cells;
  }

 private:
  /// Whether a place is inside the mesh: at least 10 of 16 horizontal rays meet the surface. A room
  /// with an open front counts as inside.
  static bool is_inside(const RayScene& rays, const Vector3d& place, double reach_m) {
    constexpr int directions = 16;
    int hits = 0;
    for (int i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / directions;
      hits += rays.cast(place, {std::cos(angle), std::sin(angle), 0}, reach_m) ? 1 : 0;
    }
    return hits >= directions * 5 / 8;
  }

  /// Keeps only the largest connected set of free cells.
  void keep_largest_part() {
    std::vector<int> part(clearance_.size(), -1);
    std::vector<int> sizes;
    for (int start = 0; start < size(); ++start) {
      if (!is_free(start) || part[static_cast<std::size_t>(start)] >= 0) continue;
      const int label = static_cast<int>(sizes.size());
      std::vector<int> open = {start};
      part[static_cast<std::size_t>(start)] = label;
      sizes.push_back(0);
      while (!open.empty()) {
        const int cell = open.back();
        open.pop_back();
        ++sizes.back();
        for (const int next : free_neighbours(cell)) {
          int& next_part = part[static_cast<std::size_t>(next)];
          if (next_part >= 0) continue;
          next_part = label;
          open.push_back(next);
        }
      }
    }
    if (sizes.empty()) return;
    const auto largest = static_cast<int>(std::ranges::max_element(sizes) - sizes.begin());
    for (std::size_t i = 0; i < part.size(); ++i) {
      if (part[i] != largest) clearance_[i] = 0;
    }
  }

  Vector3d origin_;
  double cell_m_;
  int cols_ = 0;
  int rows_ = 0;
  std::vector<double> clearance_;
};

Vector3d middle_of_free_space(const FloorPlan& plan) {
  Vector3d sum = Vector3d::Zero();
  int count = 0;
  for (int cell = 0; cell < plan.size(); ++cell) {
    if (!plan.is_free(cell)) continue;
    sum += plan.middle(cell);
    ++count;
  }
  return sum / count;
}

/// For each of 12 sectors around `middle`, the free cell with the largest product of its distance
/// from the middle and its clearance. Sectors without free cells are left out.
std::vector<int> stations_around(const FloorPlan& plan, const Vector3d& middle) {
  constexpr int sectors = 12;
  std::vector<int> best(sectors, -1);
  std::vector<double> best_score(sectors, 0);
  for (int cell = 0; cell < plan.size(); ++cell) {
    if (!plan.is_free(cell)) continue;
    const Vector3d away = plan.middle(cell) - middle;
    const double turn = std::atan2(away.y(), away.x()) / (2 * std::numbers::pi) + 0.5;
    const auto sector = static_cast<std::size_t>(std::min<int>(turn * sectors, sectors - 1));
    const double score = away.norm() * std::min(plan.clearance_m(cell), 1.0);
    if (score <= best_score[sector]) continue;
    best_score[sector] = score;
    best[sector] = cell;
  }
  std::erase(best, -1);
  return best;
}

/// The cells of the cheapest path from one cell to another, without the first cell (Dijkstra's
/// algorithm). Cells near the surface cost more.
std::vector<int> way_between(const FloorPlan& plan, int from, int to) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> cost(static_cast<std::size_t>(plan.size()), infinity);
  std::vector<int> previous(static_cast<std::size_t>(plan.size()), -1);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  cost[static_cast<std::size_t>(from)] = 0;
  open.emplace(0, from);
  while (!open.empty()) {
    const auto [spent, cell] = open.top();
    open.pop();
    if (cell == to) break;
    if (spent > cost[static_cast<std::size_t>(cell)]) continue;
    for (const int next : plan.free_neighbours(cell)) {
      const double total = spent + 1 / (plan.clearance_m(next) * plan.clearance_m(next));
      if (total >= cost[static_cast<std::size_t>(next)]) continue;
      cost[static_cast<std::size_t>(next)] = total;
      previous[static_cast<std::size_t>(next)] = cell;
      open.emplace(total, next);
    }
  }
  std::vector<int> way;
  for (int cell = to; cell != from; cell = previous[static_cast<std::size_t>(cell)]) {
    way.push_back(cell);
  }
  std::ranges::reverse(way);
  return way;
}

/// A loop through the free space. The camera looks along the circle around the centre of that
/// space, so that the viewing direction never flips, however the path winds. Empty if there is no
/// free space, or too little of it.
CameraPath loop_inside(const FloorPlan& plan) {
  if (!plan.has_space()) return {};
  const Vector3d middle = middle_of_free_space(plan);
  const std::vector<int> stations = stations_around(plan, middle);
  std::vector<int> cells;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const std::vector<int> way =
        way_between(plan, stations[i], stations[(i + 1) % stations.size()]);
    cells.insert(cells.end(), way.begin(), way.end());
  }
  std::vector<Waypoint> waypoints;
  for (const int cell : cells) {
    const Vector3d away = plan.middle(cell) - middle;
    waypoints.push_back({plan.middle(cell), {-away.y(), away.x(), -0.1 * away.norm()}});
    // At the centre there is no direction along the circle.
    if (away.norm() < plan.cell_m()) waypoints.pop_back();
  }
  if (waypoints.size() < 3) return {};
  return {std::move(waypoints), true};
}

/// A circle around an object. The camera looks at the centre of the object.
CameraPath orbit_around(const Eigen::AlignedBox3d& box) {
  constexpr int count = 24;
  const double radius_m = std::max(0.9 * box.diagonal().norm(), 0.5);
  std::vector<Waypoint> waypoints;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * i / count;
    const Vector3d place =
        box.center() + radius_m * Vector3d(std::cos(angle), std::sin(angle), 0.3);
    waypoints.push_back(look_at(place, box.center()));
  }
  return {std::move(waypoints), true};
}

}  // namespace

Scene make_mesh_scene(const std::filesystem::path& file) {
  Scene scene;
  scene.name = file.stem().string();
  scene.surface = read_mesh(file);
  const Eigen::AlignedBox3d box = bounds(scene.surface);
  const RayScene rays(scene.surface);
  const FloorPlan plan(rays, box);
  const double diagonal_m = box.diagonal().norm();
  scene.path = loop_inside(plan);
  scene.max_range_m = diagonal_m;
  if (scene.path.empty()) {
    scene.path = orbit_around(box);
    scene.max_range_m = 2 * diagonal_m;
  }
  scene.max_range_m = std::min(scene.max_range_m, max_written_range_m);
  scene.min_frames = 100;
  return scene;
}

}  // namespace tofmap
