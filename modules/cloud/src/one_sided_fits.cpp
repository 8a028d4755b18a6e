// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How PlaneFits fits planes near folds.

#include "plane_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include <Eigen/Core>
#include <Eigen/LU>

namespace tofmap {
namespace {

/// Standard deviations by which the mean of the pixels next to a pixel may be off its plane. Noise
/// alone exceeds this at every eighth pixel. A needless fit to half a window costs little, while a
/// plane across a fold is wrong by several of its own standard deviations.
constexpr double most_sigmas_off = 1.5;

/// The window of a pixel has this many times the radius of the pixels next to it: 3 x 3 of 7 x 7.
constexpr int radii_of_window = 3;

/// A part of a window: the pixels whose offsets have no negative product with either direction.
struct WindowSide {
  int down_1, right_1;
  int down_2, right_2;

  bool contains(int down, int right) const {
    return down * down_1 + right * right_1 >= 0 && down * down_2 + right * right_2 >= 0;
  }
};

/// Halves, and after them quarters, of which each leaves out pixels of a second fold.
constexpr std::size_t halves = 8;
constexpr std::array<WindowSide, 12> sides{{{1, 0, 1, 0},
                                            {-1, 0, -1, 0},
                                            {0, 1, 0, 1},
                                            {0, -1, 0, -1},
                                            {1, 1, 1, 1},
                                            {-1, -1, -1, -1},
                                            {1, -1, 1, -1},
                                            {-1, 1, -1, 1},
                                            {1, 0, 0, 1},
                                            {1, 0, 0, -1},
                                            {-1, 0, 0, 1},
                                            {-1, 0, 0, -1}}};

/// A pixel of a window, relative to the pixel in its centre.
struct WindowPixel {
  Eigen::Vector3d place;  ///< 1 and the differences of the tangents
  double q;               ///< difference of inverse depths
  double weight;          ///< 1 / variance
  std::uint32_t sides;    ///< a bit for each of `sides` that the pixel is in
  bool is_next;           ///< whether it is next to the centre
};

/// The sums of the normal equations of a plane.
class PlaneSums {
 public:
  void add(const WindowPixel& pixel) {
    const double x = pixel.place.y();
    const double y = pixel.place.z();
    const double weighted_x = pixel.weight * x;
    const double weighted_y = pixel.weight * y;
    const double weighted_q = pixel.weight * pixel.q;
    Sums one;
    one << pixel.weight, weighted_x, weighted_y, weighted_x * x, weighted_x * y, weighted_y * y,
        weighted_q, weighted_q * x, weighted_q * y, weighted_q * pixel.q, 1, 0;
    sums_ += one;
  }
  void add(const PlaneSums& others) { sums_ += others.sums_; }

  int count() const { return static_cast<int>(sums_[10]); }
  double squares() const { return sums_[9]; }
  Eigen::Vector3d right() const { return sums_.segment<3>(6); }
  Eigen::Matrix3d normal() const {
    return Eigen::Matrix3d{{sums_[0], sums_[1], sums_[2]},
                           {sums_[1], sums_[3], sums_[4]},
                           {sums_[2], sums_[4], sums_[5]}};
  }

 private:
  using Sums = Eigen::Array<double, 12, 1>;  // the last one fills a vector of the processor

  Sums sums_ = Sums::Zero();
};

/// A plane as in PlaneRow.
struct SidePlane {
  Eigen::Vector3d plane;     ///< offset from the q of the pixel, a, b
  Eigen::Vector3d variance;  ///< of these
  double scatter = 0;        ///< of the neighbours, as a multiple of the predicted variance
  int neighbours = 0;

  double excess() const { return std::max(1.0, scatter); }
};

/// The plane through pixels. Empty if they do not span one. `least_spread2` as for PlaneFits.
std::optional<SidePlane> plane_through(const PlaneSums& sums, double least_spread2) {
  constexpr double least_determinant = 1e-3;
  const Eigen::Matrix3d normal = sums.normal();
  const double least = least_spread2 * normal(0, 0);
  if (!(normal(1, 1) > least && normal(2, 2) > least)) return std::nullopt;
  // Scaled to a unit diagonal, since tangents are small numbers.
  const Eigen::Vector3d scale = normal.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  if (!(scaled.determinant() > least_determinant)) return std::nullopt;
  const Eigen::Matrix3d inverse = scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  SidePlane found;
  found.plane = inverse * sums.right();
  found.scatter = (sums.squares() - found.plane.dot(sums.right())) / std::max(1, sums.count() - 3);
  found.variance = found.excess() * inverse.diagonal();
  found.neighbours = sums.count();
  return found;
}

/// How far pixels are off a plane: the weighted mean of their residuals. Pixels of other surfaces
/// do not count.
class Offset {
 public:
  explicit Offset(double gate2) : gate2_(gate2) {}

  void add(double residual, double weight) {
    if (!(weight * residual * residual <= gate2_)) return;  // NaN, too
    sum_ += weight * residual;
    weights_ += weight;
  }

  double q() const { return weights_ > 0 ? sum_ / weights_ : 0; }

  /// Whether noise does not explain it. `excess` is how much the variance of the pixels exceeds the
  /// predicted one, `shared` how many pixels share noise.
  bool is_significant(double excess, double shared) const {
    return sum_ * sum_ > most_sigmas_off * most_sigmas_off * excess * shared * weights_;
  }

 private:
  double gate2_;
  double sum_ = 0;
  double weights_ = 0;
};

}  // namespace

/// The window of a pixel, and the planes that fit to its sides.
class PlaneFits::OneSidedFits {
 public:
  explicit OneSidedFits(const PlaneFits& fits);

  /// How far the pixels next to a pixel are off its plane.
  Offset offset_from_own(int row, int col, const PlaneRow& planes) const;

  /// Takes the window of a pixel.
  void move_to(int row, int col);

  /// The plane through that side of the window which fits best. `shared` is how many pixels share
  /// noise, `whole` the plane through all sides. Empty if none fits better than that.
  std::optional<SidePlane> best_side(const Eigen::Vector3d& whole, double shared) const;

 private:
  Offset offset_from(const Eigen::Vector3d& plane, std::uint32_t among) const;
  std::optional<SidePlane> refined(const Eigen::Vector3d& plane, std::uint32_t side) const;
  std::optional<SidePlane> best_of(std::size_t first, std::size_t end, double most_cost,
                                   double shared) const;
  double cost(const Eigen::Vector3d& plane, std::uint32_t among) const;

  const PlaneFits& fits_;
  int near_;                          ///< radius of the pixels that are next to the centre
  std::vector<std::uint32_t> parts_;  ///< those of the window whose pixels are in the same sides
  std::vector<std::size_t> part_at_;  ///< index into parts_ by place in the window
  std::vector<WindowPixel> pixels_;
  std::vector<PlaneSums> sums_of_parts_;
  double own_weight_ = 0;
};

PlaneFits::OneSidedFits::OneSidedFits(const PlaneFits& fits)
    : fits_(fits), near_(std::max(1, fits.margin_ / radii_of_window)) {
  for (int down = -fits_.margin_; down <= fits_.margin_; ++down) {
    for (int right = -fits_.margin_; right <= fits_.margin_; ++right) {
      std::uint32_t in = 0;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        in |= sides[i].contains(down, right) ? 1U << i : 0U;
      }
      const auto part = std::ranges::find(parts_, in);
      part_at_.push_back(static_cast<std::size_t>(part - parts_.begin()));
      if (part == parts_.end()) parts_.push_back(in);
    }
  }
}

Offset PlaneFits::OneSidedFits::offset_from_own(int row, int col, const PlaneRow& planes) const {
  const auto i = static_cast<std::size_t>(col);
  const std::size_t own = fits_.place(row, col);
  Offset offset(fits_.gate2_);
  for (int down = -near_; down <= near_; ++down) {
    for (int right = -near_; right <= near_; ++right) {
      const std::size_t at = own + static_cast<std::size_t>(down * fits_.stride_ + right);
      const float plane_q = planes.q0[i] +
                            planes.a[i] * (fits_.tangent_x_[at] - fits_.tangent_x_[own]) +
                            planes.b[i] * (fits_.tangent_y_[at] - fits_.tangent_y_[own]);
      offset.add(fits_.q_[at] - plane_q, 1 / fits_.variance_[at]);
    }
  }
  return offset;
}

void PlaneFits::OneSidedFits::move_to(int row, int col) {
  const std::size_t own = fits_.place(row, col);
  own_weight_ = 1 / fits_.variance_[own];
  pixels_.clear();
  sums_of_parts_.assign(parts_.size(), {});
  std::size_t place = 0;
  for (int down = -fits_.margin_; down <= fits_.margin_; ++down) {
    for (int right = -fits_.margin_; right <= fits_.margin_; ++right, ++place) {
      const std::size_t at = own + static_cast<std::size_t>(down * fits_.stride_ + right);
      if (std::isnan(fits_.q_[at])) continue;
      pixels_.push_back({.place = {1, fits_.tangent_x_[at] - fits_.tangent_x_[own],
                                   fits_.tangent_y_[at] - fits_.tangent_y_[own]},
                         .q = fits_.q_[at] - fits_.q_[own],
                         .weight = 1 / fits_.variance_[at],
                         .sides = parts_[part_at_[place]],
                         .is_next = std::abs(down) <= near_ && std::abs(right) <= near_});
      sums_of_parts_[part_at_[place]].add(pixels_.back());
    }
  }
}

/// How far those pixels of a side that are next to the centre are off a plane.
Offset PlaneFits::OneSidedFits::offset_from(const Eigen::Vector3d& plane,
                                            std::uint32_t among) const {
  Offset offset(fits_.gate2_);
  for (const WindowPixel& pixel : pixels_) {
    if (!pixel.is_next || (pixel.sides & among) == 0) continue;
    offset.add(pixel.q - plane.dot(pixel.place), pixel.weight);
  }
  return offset;
}

/// Mean square residual of the pixels of a side, in variances. Those of other surfaces count as if
/// they were at the gate.
double PlaneFits::OneSidedFits::cost(const Eigen::Vector3d& plane, std::uint32_t among) const {
  double sum = 0;
  int count = 0;
  for (const WindowPixel& pixel : pixels_) {
    if ((pixel.sides & among) == 0) continue;
    const double residual = pixel.q - plane.dot(pixel.place);
    sum += std::min(pixel.weight * residual * residual, static_cast<double>(fits_.gate2_));
    ++count;
  }
  return sum / std::max(1, count - 3);
}

/// The plane through those pixels of a side that are near a plane.
std::optional<SidePlane> PlaneFits::OneSidedFits::refined(const Eigen::Vector3d& plane,
                                                          std::uint32_t side) const {
  PlaneSums sums;
  for (const WindowPixel& pixel : pixels_) {
    if ((pixel.sides & side) == 0) continue;
    const double residual = pixel.q - plane.dot(pixel.place);
    if (pixel.weight * residual * residual <= fits_.gate2_) sums.add(pixel);
  }
  if (sums.count() < fits_.min_neighbours_) return std::nullopt;
  return plane_through(sums, fits_.least_spread2_);
}

/// The plane through that of some sides whose pixels are on a plane most nearly. Empty if it is not
/// the plane of the pixel either, or fits worse than `most_cost`.
std::optional<SidePlane> PlaneFits::OneSidedFits::best_of(std::size_t first, std::size_t end,
                                                          double most_cost, double shared) const {
  std::optional<SidePlane> best;
  std::uint32_t side = 0;
  for (std::size_t i = first; i < end; ++i) {
    PlaneSums sums;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      if ((parts_[k] >> i & 1U) != 0) sums.add(sums_of_parts_[k]);
    }
    if (sums.count() < fits_.min_neighbours_) continue;
    const auto plane = plane_through(sums, fits_.least_spread2_);
    if (!plane || (best && plane->scatter >= best->scatter)) continue;
    best = plane;
    side = 1U << i;
  }
  if (best) best = refined(best->plane, side);
  if (!best || own_weight_ * best->plane(0) * best->plane(0) > fits_.gate2_ ||
      offset_from(best->plane, side).is_significant(best->excess(), shared) ||
      cost(best->plane, side) >= most_cost) {
    return std::nullopt;
  }
  return best;
}

std::optional<SidePlane> PlaneFits::OneSidedFits::best_side(const Eigen::Vector3d& whole,
                                                            double shared) const {
  const double most_cost = cost(whole, ~0U);
  const auto half = best_of(0, halves, most_cost, shared);
  return half ? half : best_of(halves, sides.size(), most_cost, shared);
}

void PlaneFits::refit_folds(int row, std::span<const int> columns, const float* averaged,
                            PlaneRow& out) const {
  OneSidedFits window(*this);
  for (const int col : columns) {
    const auto i = static_cast<std::size_t>(col);
    if (out.neighbours[i] == 0) continue;
    const double shared = averaged == nullptr ? 1 : averaged[col];
    const Offset offset = window.offset_from_own(row, col, out);
    if (!offset.is_significant(out.excess[i], shared)) continue;
    window.move_to(row, col);
    const float own_q = q_[place(row, col)];
    const Eigen::Vector3d whole(out.q0[i] - own_q, out.a[i], out.b[i]);
    const auto side = window.best_side(whole, shared);
    if (!side) {
      out.q0_variance[i] += static_cast<float>(offset.q() * offset.q());
      continue;
    }
    out.q0[i] = own_q + static_cast<float>(side->plane(0));
    out.a[i] = static_cast<float>(side->plane(1));
    out.b[i] = static_cast<float>(side->plane(2));
    out.q0_variance[i] = static_cast<float>(side->variance(0));
    out.a_variance[i] = static_cast<float>(side->variance(1));
    out.b_variance[i] = static_cast<float>(side->variance(2));
    out.excess[i] = static_cast<float>(side->excess());
    out.neighbours[i] = side->neighbours;
  }
}

}  // namespace tofmap
