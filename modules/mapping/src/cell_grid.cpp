// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cell_grid.hpp"

#include "keyframe_view.hpp"
#include "tofmap/mapping/moving_regions.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

int side_of_cell_px(const CameraModel& camera) {
  constexpr double cells_per_rad = 32;
  return std::max(1, static_cast<int>(std::lround(camera.fx_px / cells_per_rad)));
}

/// A cell and the seed that its region has grown from to it.
struct Grown {
  std::size_t cell;
  std::size_t seed;
};

/// The neighbours of a cell to the left and right, above and below.
std::vector<std::size_t> neighbours(const CellGrid& grid, std::size_t cell) {
  const auto cols = static_cast<std::size_t>(grid.cols());
  std::vector<std::size_t> beside;
  if (cell % cols > 0) beside.push_back(cell - 1);
  if (cell % cols + 1 < cols) beside.push_back(cell + 1);
  if (cell >= cols) beside.push_back(cell - cols);
  if (cell + cols < grid.size()) beside.push_back(cell + cols);
  return beside;
}

/// Distance between a surface and another one beside it in the image at which they are two things.
constexpr float apart_m = 0.3F;

/// Whether a surface seems to go on from the one above it in a column of cells: the point above is
/// near the line through the next two points, as where a floor meets a wall.
bool goes_on_from_above(const CellGrid& grid, const std::vector<std::size_t>& column,
                        std::size_t i) {
  if (i + 1 == column.size()) return true;
  const Eigen::Vector3f& point = grid.point_m(column[i]);
  const Eigen::Vector3f along = (point - grid.point_m(column[i + 1])).normalized();
  return (grid.point_m(column[i - 1]) - point).cross(along).norm() < apart_m;
}

bool hides_what_is_above(const CellGrid& grid, const std::vector<std::size_t>& column,
                         std::size_t i) {
  return grid.range_m(column[i - 1]) > grid.range_m(column[i]) + apart_m &&
         !goes_on_from_above(grid, column, i);
}

void mark_as_moving(SurfacePoint& point) {
  constexpr float none = nan;
  point.getNormalVector3fMap().setConstant(none);
  point.normal_sigma_rad = none;
  point.confidence = moving_confidence;
}

bool is_in_region_beside(const SurfacePoint& point, int row, int col, const CellGrid& grid,
                         const Cells<int>& regions) {
  constexpr float same_range_m = 0.15F;
  const float range_m = point.getVector3fMap().norm();
  const int cell_row = row / grid.side_px();
  const int cell_col = col / grid.side_px();
  for (int r = std::max(0, cell_row - 1); r <= std::min(grid.rows() - 1, cell_row + 1); ++r) {
    for (int c = std::max(0, cell_col - 1); c <= std::min(grid.cols() - 1, cell_col + 1); ++c) {
      const auto cell = static_cast<std::size_t>(r * grid.cols() + c);
      if (regions[cell] != no_region && std::abs(range_m - grid.range_m(cell)) < same_range_m) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

CellGrid::CellGrid(const SurfaceCloud& cloud, const CameraModel& camera)
    : side_px_(side_of_cell_px(camera)),
      rows_(static_cast<int>(cloud.height) / side_px_),
      cols_(static_cast<int>(cloud.width) / side_px_),
      cell_rad_(side_px_ / camera.fx_px) {
  points_m_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(cols_));
  for (int row = 0; row < rows_; ++row) {
    for (int col = 0; col < cols_; ++col) {
      const SurfacePoint& point =
          cloud.at(col * side_px_ + side_px_ / 2, row * side_px_ + side_px_ / 2);
      points_m_.emplace_back(point.getVector3fMap());
      is_sure_.push_back(point.has_normal() && point.confidence >= sure_confidence ? 1 : 0);
      ranges_m_.push_back(point.has_normal() ? points_m_.back().norm() : 0);
    }
  }
}

std::optional<std::size_t> CellGrid::cell_at(const std::optional<Eigen::Vector2d>& pixel) const {
  if (!pixel) return std::nullopt;
  const double col = std::floor((pixel->x() + 0.5) / side_px_);
  const double row = std::floor((pixel->y() + 0.5) / side_px_);
  if (!(row >= 0 && col >= 0 && row < rows_ && col < cols_)) return std::nullopt;
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(cols_) +
         static_cast<std::size_t>(col);
}

bool CellGrid::are_joined(std::size_t a, std::size_t b) const {
  constexpr double steepest = 2;  // tan 63°
  if (!has_surface(a) || !has_surface(b)) return false;
  const double width_m = cell_rad_ * std::min(ranges_m_[a], ranges_m_[b]);
  return std::abs(ranges_m_[a] - ranges_m_[b]) < steepest * width_m;
}

Cells<int> grow_regions(const CellGrid& grid, const Cells<int>& seeds, const Cells<char>& barred) {
  constexpr float reach_m = 0.6F;
  constexpr int least_seeds = 6;
  const auto is_seed = [&](std::size_t cell) { return seeds[cell] != no_region; };
  const auto may_grow = [&](std::size_t seed, std::size_t cell) {
    return seeds[seed] == growing && barred[cell] == 0 &&
           (grid.point_m(cell) - grid.point_m(seed)).norm() < reach_m;
  };
  Cells<int> regions(grid.size(), no_region);
  Cells<char> is_taken(grid.size(), 0);
  for (std::size_t first = 0; first < grid.size(); ++first) {
    if (!is_seed(first) || is_taken[first] != 0) continue;
    std::vector<Grown> region{{first, first}};
    is_taken[first] = 1;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const Grown at = region[next];
      for (const std::size_t cell : neighbours(grid, at.cell)) {
        if (is_taken[cell] != 0 || !grid.are_joined(at.cell, cell)) continue;
        if (!is_seed(cell) && !may_grow(at.seed, cell)) continue;
        is_taken[cell] = 1;
        region.push_back({cell, is_seed(cell) ? cell : at.seed});
      }
    }
    int count = 0;
    int value = seeds[first];
    for (const Grown& grown : region) {
      if (!is_seed(grown.cell)) continue;
      ++count;
      value = std::min(value, seeds[grown.cell]);
    }
    if (count < least_seeds) continue;
    for (const Grown& grown : region) regions[grown.cell] = value;
  }
  return regions;
}

Cells<int> front_regions(const CellGrid& grid) {
  Cells<int> front(grid.size(), no_region);
  const auto cols = static_cast<std::size_t>(grid.cols());
  for (std::size_t col = 0; col < cols; ++col) {
    std::vector<std::size_t> column;
    for (std::size_t cell = col; cell < grid.size(); cell += cols) {
      if (grid.has_surface(cell)) column.push_back(cell);
    }
    bool is_in_front = false;
    for (std::size_t i = 1; i < column.size(); ++i) {
      if (!grid.are_joined(column[i - 1], column[i])) {
        is_in_front = hides_what_is_above(grid, column, i) ||
                      (is_in_front && goes_on_from_above(grid, column, i));
      }
      if (is_in_front) front[column[i]] = growing;
    }
  }
  return grow_regions(grid, front, Cells<char>(grid.size(), 0));
}

std::shared_ptr<const SurfaceCloud> without_regions(const SurfaceCloud& cloud, const CellGrid& grid,
                                                    const Cells<int>& regions) {
  const auto out = std::make_shared<SurfaceCloud>(cloud);
  const int width = static_cast<int>(cloud.width);
  for (int row = 0; row < static_cast<int>(cloud.height); ++row) {
    for (int col = 0; col < width; ++col) {
      SurfacePoint& point = out->at(col, row);
      if (point.has_position() && is_in_region_beside(point, row, col, grid, regions)) {
        mark_as_moving(point);
      }
    }
  }
  return out;
}

}  // namespace tofmap
