// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "standing_space.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>

namespace tofmap {
namespace {

using Eigen::Vector3d;

constexpr double cell_m = 0.05;
constexpr double level_m = 0.5;        ///< floors of one place that are farther apart are storeys
constexpr double max_step_up_m = 0.2;  ///< between neighbouring places
/// Half the width of a person with arms, and half the diagonal of a cell.
constexpr double clearance_m = 0.32 + 0.036;
constexpr double person_height_m = 1.95;

int cell_of(double coordinate_m) { return static_cast<int>(std::floor(coordinate_m / cell_m)); }

}  // namespace

StandingSpace::StandingSpace(const RayScene& still, const Trajectory& path, double reach_m)
    : still_(still) {
  std::vector<double> drops;
  for (const StampedPose& pose : path) {
    constexpr double limit_m = 100;
    const auto drop = drop_m(pose.world_from_camera.translation(), limit_m);
    if (drop) drops.push_back(*drop);
  }
  has_floor_ = !drops.empty();
  if (has_floor_) {
    const auto middle = drops.begin() + static_cast<std::ptrdiff_t>(drops.size() / 2);
    std::ranges::nth_element(drops, middle);
    eye_height_m_ = *middle;
  }
  explore(path, static_cast<int>((reach_m + eye_height_m_) / cell_m));
}

double StandingSpace::floor_beneath_m(const Vector3d& camera_m) const {
  // What is much nearer than usual is furniture.
  constexpr double tolerance_m = 0.4;
  const auto drop = drop_m(camera_m, eye_height_m_ + tolerance_m);
  const bool is_floor = drop && std::abs(*drop - eye_height_m_) < tolerance_m;
  return camera_m.z() - (is_floor ? *drop : eye_height_m_);
}

std::optional<Vector3d> StandingSpace::standing_place(const Vector3d& place_m) const {
  const Cell* cell = find(cell_of(place_m.x()), cell_of(place_m.y()), place_m.z());
  if (cell == nullptr || !cell->is_free) return std::nullopt;
  return Vector3d(place_m.x(), place_m.y(), cell->middle_m.z());
}

void StandingSpace::block(const Vector3d& centre_m, double radius_m) {
  for (auto& [key, cell] : cells_) {
    if ((cell.middle_m - centre_m).head<2>().norm() < radius_m) cell.is_free = false;
  }
}

std::vector<Vector3d> StandingSpace::free_places(double spacing_m) const {
  const int every = std::max(1, static_cast<int>(std::lround(spacing_m / cell_m)));
  std::vector<Vector3d> places;
  for (const auto& [key, cell] : cells_) {
    const bool is_on_grid =
        cell_of(cell.middle_m.x()) % every == 0 && cell_of(cell.middle_m.y()) % every == 0;
    if (cell.is_free && is_on_grid) places.push_back(cell.middle_m);
  }
  return places;
}

std::uint64_t StandingSpace::key(int col, int row, double floor_m) {
  const auto part = [](int value) { return static_cast<std::uint64_t>(value + (1 << 20)); };
  return (part(col) << 42U) | (part(row) << 21U) |
         part(static_cast<int>(std::lround(floor_m / level_m)));
}

std::optional<double> StandingSpace::drop_m(const Vector3d& from, double limit_m) const {
  const auto hit = still_.cast(from, -Vector3d::UnitZ(), limit_m);
  return hit ? std::optional(hit->range_m) : std::nullopt;
}

/// The cell as it is found by someone who stands next to it, on a floor of the given height.
StandingSpace::Cell StandingSpace::inspect(int col, int row, double near_floor_m, int steps) const {
  Cell cell{{(col + 0.5) * cell_m, (row + 0.5) * cell_m, near_floor_m}, false, steps};
  if (has_floor_) {
    const auto drop = drop_m(cell.middle_m + Vector3d(0, 0, 2 * max_step_up_m), 3 * max_step_up_m);
    if (!drop) return cell;
    cell.middle_m.z() = near_floor_m + 2 * max_step_up_m - *drop;
    if (cell.middle_m.z() > near_floor_m + max_step_up_m) return cell;
  }
  // Balls from the floor to the top of the head.
  constexpr double lift_m = 0.03;
  constexpr double top_m = person_height_m - clearance_m;
  constexpr int balls = 6;
  for (int i = 0; i < balls; ++i) {
    const double height_m = clearance_m + lift_m + i * (top_m - clearance_m - lift_m) / (balls - 1);
    if (still_.clearance_m(cell.middle_m + Vector3d(0, 0, height_m), clearance_m) < clearance_m) {
      return cell;
    }
  }
  cell.is_free = true;
  return cell;
}

const StandingSpace::Cell* StandingSpace::find(int col, int row, double floor_m) const {
  for (const double offset_m : {0.0, -level_m, level_m}) {
    const auto found = cells_.find(key(col, row, floor_m + offset_m));
    if (found == cells_.end()) continue;
    if (std::abs(found->second.middle_m.z() - floor_m) < level_m / 2 + 0.01) return &found->second;
  }
  return nullptr;
}

/// Breadth-first search from the cells beneath the path.
void StandingSpace::explore(const Trajectory& path, int max_steps) {
  struct Open {
    int col;
    int row;
    double floor_m;
    int steps;
  };
  std::queue<Open> open;
  const auto visit = [&](int col, int row, double near_floor_m, int steps) {
    if (find(col, row, near_floor_m) != nullptr) return;
    const Cell cell = inspect(col, row, near_floor_m, steps);
    const bool is_new = cells_.emplace(key(col, row, cell.middle_m.z()), cell).second;
    if (is_new && cell.is_free && steps < max_steps) {
      open.push({col, row, cell.middle_m.z(), steps});
    }
  };
  for (const StampedPose& pose : path) {
    const Vector3d camera_m = pose.world_from_camera.translation();
    visit(cell_of(camera_m.x()), cell_of(camera_m.y()), floor_beneath_m(camera_m), 0);
  }
  while (!open.empty()) {
    const Open from = open.front();
    open.pop();
    constexpr std::array<std::array<int, 2>, 4> sides{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    for (const auto& [right, up] : sides) {
      visit(from.col + right, from.row + up, from.floor_m, from.steps + 1);
    }
  }
}

}  // namespace tofmap
