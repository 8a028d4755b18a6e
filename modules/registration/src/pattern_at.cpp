// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pattern_at.hpp"

#include "pcl_points.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <pcl/kdtree/kdtree_flann.h>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// About how many directions are kept, and how many of those are compared with their neighbours:
/// enough for shares to within half a percent.
constexpr std::size_t most_points = 40000;
constexpr std::size_t most_examined = 2000;

/// Smallest number of directions that have a pattern.
constexpr std::size_t least_pattern_points = 200;

constexpr int neighbours = 16;
constexpr std::size_t spacing_neighbours = 4;

/// Directions closer together than this are copies of one point.
constexpr float same_direction_rad = 1e-6F;

constexpr float similar_range = 1.1F;
constexpr float clearly_nearer = 1.2F;

/// Number of blocks of directions, with `along_side` × `along_side` on each side of a cube.
std::size_t direction_blocks(int along_side) {
  return 6 * static_cast<std::size_t>(along_side * along_side);
}

/// The block of directions that a vector, which must not be zero, falls into.
std::size_t direction_block(const Eigen::Vector3d& vector, int along_side) {
  Eigen::Index axis = 0;
  const double most = vector.cwiseAbs().maxCoeff(&axis);
  const auto cell = [&](double value) {
    const int at = static_cast<int>((value / most + 1) / 2 * along_side);
    return std::clamp(at, 0, along_side - 1);
  };
  const int side = 2 * static_cast<int>(axis) + (vector[axis] < 0 ? 1 : 0);
  const int block = (side * along_side + cell(vector[(axis + 1) % 3])) * along_side +
                    cell(vector[(axis + 2) % 3]);
  return static_cast<std::size_t>(block);
}

/// Directions from a place, with a tree for nearest directions.
struct Directions {
  std::vector<Eigen::Vector3f> units;
  std::vector<float> ranges;
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
};

/// The directions of all points, or of whole blocks at even intervals: thinning out single points
/// would disturb the pattern.
Directions directions_from(std::span<const Eigen::Vector3d> points, const Eigen::Vector3d& place) {
  constexpr int blocks_along_side = 16;
  const std::size_t blocks = direction_blocks(blocks_along_side);
  std::vector<bool> is_occupied(blocks);
  for (const Eigen::Vector3d& point : points) {
    if (point != place) is_occupied[direction_block(point - place, blocks_along_side)] = true;
  }
  const std::size_t one_in = (points.size() + most_points - 1) / most_points;
  std::vector<bool> is_kept(blocks);
  std::size_t occupied = 0;
  for (std::size_t block = 0; block < blocks; ++block) {
    if (is_occupied[block]) is_kept[block] = occupied++ % one_in == 0;
  }
  Directions out;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d ray = point - place;
    const double range = ray.norm();
    if (!(range > 0) || !is_kept[direction_block(ray, blocks_along_side)]) continue;
    out.units.emplace_back((ray / range).cast<float>());
    out.ranges.push_back(static_cast<float>(range));
  }
  if (!out.units.empty()) out.tree.setInputCloud(pcl_points(out.units));
  return out;
}

/// A neighbouring direction.
struct Neighbour {
  std::size_t index = 0;
  float angle_rad = 0;
};

/// Searches neighbours; keeps its buffers.
class NeighbourSearch {
 public:
  explicit NeighbourSearch(const Directions& directions) : directions_(directions) {}

  /// The nearest other directions, without copies of the same one.
  const std::vector<Neighbour>& of(std::size_t index) {
    const Eigen::Vector3f& unit = directions_.units[index];
    directions_.tree.nearestKSearch({unit.x(), unit.y(), unit.z()}, neighbours + 1, indices_,
                                    squares_);
    found_.clear();
    for (std::size_t i = 0; i < indices_.size(); ++i) {
      const float angle_rad = std::sqrt(squares_[i]);
      if (angle_rad < same_direction_rad) continue;
      found_.push_back({static_cast<std::size_t>(indices_[i]), angle_rad});
    }
    return found_;
  }

 private:
  const Directions& directions_;
  pcl::Indices indices_;
  std::vector<float> squares_;
  std::vector<Neighbour> found_;
};

/// The mean distance to the four nearest of neighbouring directions. Empty if there are fewer.
std::optional<float> spacing_rad(const std::vector<Neighbour>& around) {
  if (around.size() < spacing_neighbours) return std::nullopt;
  float sum_rad = 0;
  for (std::size_t i = 0; i < spacing_neighbours; ++i) sum_rad += around[i].angle_rad;
  return sum_rad / spacing_neighbours;
}

bool is_similar(float one, float other) {
  return one < similar_range * other && other < similar_range * one;
}

/// Whether a nearer surface hides a point.
bool is_hidden(const std::vector<float>& ranges, std::size_t index,
               const std::vector<Neighbour>& around) {
  std::vector<float> spacings_rad;
  for (const Neighbour& other : around) {
    if (is_similar(ranges[index], ranges[other.index])) spacings_rad.push_back(other.angle_rad);
  }
  if (spacings_rad.size() < 2) return false;
  const float reach_rad = spacings_rad[1] / 2;
  return std::ranges::any_of(around, [&](const Neighbour& other) {
    return other.angle_rad < reach_rad && clearly_nearer * ranges[other.index] < ranges[index];
  });
}

}  // namespace

std::optional<Pattern> pattern_at(std::span<const Eigen::Vector3d> points,
                                  const Eigen::Vector3d& place) {
  const Directions directions = directions_from(points, place);
  if (directions.units.size() < least_pattern_points) return std::nullopt;
  const std::size_t count = std::min(most_examined, directions.units.size());
  NeighbourSearch search(directions);
  NeighbourSearch search_further(directions);
  std::size_t hidden = 0;
  std::vector<double> differences;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t index = i * directions.units.size() / count;
    const std::vector<Neighbour>& around = search.of(index);
    const auto here_rad = spacing_rad(around);
    if (!here_rad) continue;
    hidden += is_hidden(directions.ranges, index, around) ? 1 : 0;
    for (std::size_t k = 0; k < spacing_neighbours; ++k) {
      const auto other_rad = spacing_rad(search_further.of(around[k].index));
      if (other_rad) differences.push_back(std::abs(std::log(*other_rad / *here_rad)));
    }
  }
  if (differences.empty()) return std::nullopt;
  return Pattern{static_cast<double>(hidden) / static_cast<double>(count), median(differences)};
}

}  // namespace tofmap
