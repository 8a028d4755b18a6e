// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "possible_views.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

/// Places of the grid along each axis: in rooms, about a metre apart.
constexpr int along_axis = 8;

/// Size of the grid relative to the box of the cloud: cameras stand a little before what they see.
constexpr double reach = 1.2;

constexpr std::size_t most_starts = 6;
constexpr double apart_steps = 1.5;

/// Descents end at this share of the step of the grid, about 6 cm in rooms.
constexpr double least_step = 1.0 / 16;

/// A surface hides what is this many times as far away. Within a bin of 1.5 degrees, the ranges of
/// a surface differ less, unless it is seen at less than ten degrees.
constexpr double clearly_farther = 1.2;

constexpr double most_hidden = 0.05;
constexpr double most_above_best = 0.01;

struct Place {
  Eigen::Vector3d at_m = Eigen::Vector3d::Zero();
  double hidden_share = std::numeric_limits<double>::infinity();
};

Place rated(std::span<const Eigen::Vector3f> points_m, const Eigen::Vector3d& at_m) {
  const SphericalView view(points_m, at_m);
  const auto hidden = std::ranges::count_if(points_m, [&](const Eigen::Vector3f& point) {
    const Eigen::Vector3d point_m = point.cast<double>();
    const std::optional<double> nearest_m = view.range_m(point_m);
    return nearest_m && (point_m - at_m).norm() > clearly_farther * *nearest_m;
  });
  return {at_m, static_cast<double>(hidden) / static_cast<double>(points_m.size())};
}

/// The box that holds nine tenths of the points along each axis, made larger by `reach`.
Eigen::AlignedBox3d search_box(std::span<const Eigen::Vector3f> points_m) {
  Eigen::Vector3d low_m;
  Eigen::Vector3d high_m;
  std::vector<float> values_m(points_m.size());
  const auto nth = [&](std::size_t n) {
    const auto at = values_m.begin() + static_cast<std::ptrdiff_t>(n);
    std::ranges::nth_element(values_m, at);
    return static_cast<double>(*at);
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points_m, values_m.begin(), [&](const auto& p) { return p[axis]; });
    low_m[axis] = nth(values_m.size() / 20);
    high_m[axis] = nth(values_m.size() * 19 / 20);
  }
  const Eigen::Vector3d middle_m = (low_m + high_m) / 2;
  const Eigen::Vector3d half_m = reach * (high_m - low_m) / 2;
  return {middle_m - half_m, middle_m + half_m};
}

/// The best places of a grid that are apart from each other, best first.
std::vector<Place> best_of_grid(std::span<const Eigen::Vector3f> points_m,
                                const Eigen::AlignedBox3d& box_m, double apart_m) {
  std::vector<Place> all;
  for (int i = 0; i < along_axis * along_axis * along_axis; ++i) {
    const Eigen::Vector3i cell(i % along_axis, i / along_axis % along_axis,
                               i / (along_axis * along_axis));
    all.push_back(rated(points_m, box_m.min() + box_m.sizes().cwiseProduct(cell.cast<double>()) /
                                                    (along_axis - 1)));
  }
  std::ranges::stable_sort(all, std::ranges::less(), &Place::hidden_share);
  std::vector<Place> best;
  for (const Place& place : all) {
    const bool is_near = std::ranges::any_of(
        best, [&](const Place& other) { return (other.at_m - place.at_m).norm() < apart_m; });
    if (!is_near) best.push_back(place);
    if (best.size() == most_starts) break;
  }
  return best;
}

/// Moves within the box along the axes as long as less is hidden, and halves the step when not.
Place descend(std::span<const Eigen::Vector3f> points_m, const Eigen::AlignedBox3d& box_m,
              const Eigen::Vector3d& start_m, double step_m) {
  Place at = rated(points_m, start_m);
  const double end_m = step_m * least_step;
  while (step_m > end_m) {
    Place best = at;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double sign : {-1.0, 1.0}) {
        const Eigen::Vector3d next_m = at.at_m + sign * step_m * Eigen::Vector3d::Unit(axis);
        if (!box_m.contains(next_m)) continue;
        const Place next = rated(points_m, next_m);
        if (next.hidden_share < best.hidden_share) best = next;
      }
    }
    if (best.hidden_share < at.hidden_share) {
      at = best;
    } else {
      step_m /= 2;
    }
  }
  return at;
}

}  // namespace

std::vector<SphericalView> possible_views(std::span<const OrientedCloud> levels) {
  const std::vector<Eigen::Vector3f>& coarse_m = levels.front().points_m;
  const std::vector<Eigen::Vector3f>& finer_m = levels[levels.size() > 1 ? 1 : 0].points_m;
  const Eigen::AlignedBox3d box_m = search_box(coarse_m);
  const double step_m = box_m.sizes().maxCoeff() / (along_axis - 1);
  std::vector<Place> places;
  for (const Place& start : best_of_grid(coarse_m, box_m, apart_steps * step_m)) {
    places.push_back(descend(finer_m, box_m, start.at_m, step_m / 2));
  }
  const double best = std::ranges::min_element(places, {}, &Place::hidden_share)->hidden_share;
  std::vector<SphericalView> views;
  if (best > most_hidden) return views;
  for (const Place& place : places) {
    if (place.hidden_share > best + most_above_best) continue;
    views.emplace_back(levels.back().points_m, place.at_m);
  }
  return views;
}

}  // namespace tofmap
