// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>

namespace tofmap {

/// One value per cell of a grid.
template <class Value>
using Cells = std::vector<Value>;

/// A coarse image of a cloud: square cells of about 1/32 rad, which is 4 pixels at 176 pixels over
/// 69°, each with the point of one pixel in its middle. Rows and columns of pixels that do not fill
/// a cell are left out.
class CellGrid {
 public:
  CellGrid() = default;  ///< without cells
  CellGrid(const SurfaceCloud& cloud, const CameraModel& camera);

  std::size_t size() const { return points_m_.size(); }
  int rows() const { return rows_; }
  int cols() const { return cols_; }
  int side_px() const { return side_px_; }  ///< length of a cell's side

  /// Whether the pixel in the middle of a cell has a surface, with a normal.
  bool has_surface(std::size_t cell) const { return ranges_m_[cell] > 0; }
  /// Whether its wrap count is nearly certain as well.
  bool is_sure(std::size_t cell) const { return is_sure_[cell] != 0; }
  /// The point of that pixel in the frame of the camera. Meaningless without a surface.
  const Eigen::Vector3f& point_m(std::size_t cell) const { return points_m_[cell]; }
  /// Its range; 0 without a surface.
  float range_m(std::size_t cell) const { return ranges_m_[cell]; }

  /// The cell of a pixel (u, v). Empty outside of the image, and if there is no pixel.
  std::optional<std::size_t> cell_at(const std::optional<Eigen::Vector2d>& pixel) const;

  /// Whether the surfaces of two neighbouring cells may be one: their ranges differ by no more than
  /// those of a surface that is seen at 63° from its normal.
  bool are_joined(std::size_t a, std::size_t b) const;

 private:
  int side_px_ = 1;
  int rows_ = 0;
  int cols_ = 0;
  double cell_rad_ = 0;  ///< the angle that a cell covers
  std::vector<Eigen::Vector3f> points_m_;
  std::vector<float> ranges_m_;
  Cells<char> is_sure_;
};

/// Value of a cell that belongs to no region.
inline constexpr int no_region = -1;
/// Value of a seed from which a region grows.
inline constexpr int growing = 0;

/// Regions of joined cells: seeds, and cells that have grown from seeds with the value `growing`
/// over cells that are not barred, up to 0.6 m from the last seed on the way. Every cell of a
/// region gets the smallest value of its seeds. Regions of fewer than six seeds are left out. In
/// seeds and result, `no_region` stands for all other cells.
Cells<int> grow_regions(const CellGrid& grid, const Cells<int>& seeds, const Cells<char>& barred);

/// Things that stand in front of others, as regions (grow_regions()). Their seeds are the cells
/// below a surface that is at least 0.3 m farther away, downwards as far as the surface goes on.
/// People and furniture are such things; walls, doors and columns mostly are not, since they reach
/// up to the ceiling or the border of the image. The camera must be held upright.
Cells<int> front_regions(const CellGrid& grid);

/// A cloud without the surface of regions: points whose cell, or a cell beside it, is in a region
/// and has nearly the same range, become points that moves() tells. They take no part in
/// registration and map, but still tell that the space before them is free.
std::shared_ptr<const SurfaceCloud> without_regions(const SurfaceCloud& cloud, const CellGrid& grid,
                                                    const Cells<int>& regions);

}  // namespace tofmap
