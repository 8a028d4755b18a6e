// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "phasor_windows.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include <Eigen/Dense>

namespace tofmap::test {

/// A plane in phase through a pixel.
struct PlainPhasePlane {
  std::complex<double> a = 0;
  std::complex<double> b = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  double variance = 1e6;
  double lever_variance = 0;
  double slope_variance = 0;
};

/// The windows of grow_phase_planes(), a pixel at a time, in doubles, from the formulas of
/// docs/filters.md.
class PlainPhasePlanes {
 public:
  PlainPhasePlanes(const Phasors& phasors, int rows, int cols, const WindowGrowth& growth)
      : phasors_(phasors),
        rows_(rows),
        cols_(cols),
        growth_(growth),
        planes_(static_cast<std::size_t>(rows * cols)) {}

  const PlainPhasePlane& at(int v, int u) const {
    return planes_[static_cast<std::size_t>(v * cols_ + u)];
  }

  void grow(double radius_px, bool is_first) {
    std::vector<PlainPhasePlane> grown;
    for (int v = 0; v < rows_; ++v) {
      for (int u = 0; u < cols_; ++u) grown.push_back(grown_plane(v, u, radius_px, is_first));
    }
    planes_ = grown;
  }

 private:
  static std::complex<double> value(const PhasorImage& image, int v, int u) {
    return {image.re.row(v)[u], image.im.row(v)[u]};
  }

  /// The share with which a pixel takes part in another one's window.
  double agreement(const PlainPhasePlane& own, const PlainPhasePlane& other,
                   const Eigen::Vector2d& offset) const {
    const double turn = own.slope.dot(offset);
    const double difference_a = std::arg(own.a * std::polar(1.0, turn) * std::conj(other.a));
    const double difference_b =
        std::arg(own.b * std::polar(1.0, growth_.wavelength_ratio * turn) * std::conj(other.b));
    const double noise = own.variance + other.variance + offset.squaredNorm() * own.slope_variance;
    const double misfit = (4 - 2 * std::cos(difference_a) - 2 * std::cos(difference_b)) / noise;
    return std::clamp(1.5 - 1.5 * misfit / growth_.max_misfit, 0.0, 1.0);
  }

  PlainPhasePlane grown_plane(int v, int u, double radius_px, bool is_first) const {
    const PlainPhasePlane& own = at(v, u);
    const double ratio = growth_.wavelength_ratio;
    struct Member {
      Eigen::Vector2d offset;
      double weight;
      double information;
      std::complex<double> a;
      std::complex<double> b;
    };
    std::vector<Member> members;
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < cols_; ++x) {
        const Eigen::Vector2d offset(x - u, y - v);
        const double information = phasors_.information.row(y)[x];
        const double share = offset.squaredNorm() / (radius_px * radius_px);
        if (share >= 1 || information == 0) continue;
        const double weight = (1 - share) * (is_first ? 1 : agreement(own, at(y, x), offset));
        const double turn = own.slope.dot(offset);
        members.push_back({offset, weight, information,
                           value(phasors_.a, y, x) * std::polar(1.0, -turn),
                           value(phasors_.b, y, x) * std::polar(1.0, -ratio * turn)});
      }
    }
    double s = 0;
    double s2 = 0;
    std::complex<double> a = 0;
    std::complex<double> b = 0;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Member& member : members) {
      s += member.weight * member.information;
      s2 += member.weight * member.weight * member.information;
      a += member.weight * member.a;
      b += member.weight * member.b;
      middle += member.weight * member.information * member.offset;
    }
    PlainPhasePlane out;
    if (s == 0) return out;
    middle /= s;
    const double prior = 1 / (growth_.slope_sigma * growth_.slope_sigma);
    Eigen::Matrix2d spread = prior * Eigen::Matrix2d::Identity();
    Eigen::Vector2d score = -prior * own.slope;
    for (const Member& member : members) {
      const Eigen::Vector2d from_middle = member.offset - middle;
      spread += (1 + ratio * ratio) * member.weight * member.information * from_middle *
                from_middle.transpose();
      score += member.weight * member.offset *
               (std::imag(member.a * std::conj(a) / std::abs(a)) +
                ratio * std::imag(member.b * std::conj(b) / std::abs(b)));
    }
    const Eigen::Vector2d step = spread.inverse() * score;
    out.a = a / std::abs(a) * std::polar(1.0, -middle.dot(step));
    out.b = b / std::abs(b) * std::polar(1.0, -ratio * middle.dot(step));
    out.slope = own.slope + step;
    out.variance = s2 / (s * s);
    out.lever_variance = s2 / s * middle.dot(spread.inverse() * middle);
    out.slope_variance = 0.5 * s2 / s * spread.inverse().trace();
    return out;
  }

  const Phasors& phasors_;
  int rows_;
  int cols_;
  WindowGrowth growth_;
  std::vector<PlainPhasePlane> planes_;
};

}  // namespace tofmap::test
