// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "phasor_windows.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

#include <Eigen/Dense>

namespace tofmap::test {

/// A plane in phase through a pixel.
struct PlainPhasePlane {
  std::vector<std::complex<double>> phases;  ///< of each frequency
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
        planes_(static_cast<std::size_t>(rows * cols)) {
    for (PlainPhasePlane& plane : planes_) plane.phases.resize(frequencies());
  }

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
  std::size_t frequencies() const { return phasors_.frequencies.size(); }

  static std::complex<double> value(const PhasorImage& image, int v, int u) {
    return {image.re.row(v)[u], image.im.row(v)[u]};
  }

  /// The share with which a pixel takes part in another one's window.
  double agreement(const PlainPhasePlane& own, const PlainPhasePlane& other,
                   const Eigen::Vector2d& offset) const {
    const double turn = own.slope.dot(offset);
    double misfit = 0;
    for (std::size_t f = 0; f < frequencies(); ++f) {
      const double ratio = growth_.wavelength_ratios[f];
      const double difference =
          std::arg(own.phases[f] * std::polar(1.0, ratio * turn) * std::conj(other.phases[f]));
      const double variance =
          own.variance + other.variance + ratio * ratio * offset.squaredNorm() * own.slope_variance;
      misfit += (2 - 2 * std::cos(difference)) / variance;
    }
    const double largest = growth_.max_misfit * static_cast<double>(frequencies());
    return std::clamp(1.5 - 1.5 * misfit / largest, 0.0, 1.0);
  }

  PlainPhasePlane grown_plane(int v, int u, double radius_px, bool is_first) const {
    const PlainPhasePlane& own = at(v, u);
    struct Member {
      Eigen::Vector2d offset;
      double weight;
      double information;
      std::vector<std::complex<double>> phasors;
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
        members.push_back({offset, weight, information, {}});
        for (std::size_t f = 0; f < frequencies(); ++f) {
          members.back().phasors.push_back(value(phasors_.frequencies[f], y, x) *
                                           std::polar(1.0, -growth_.wavelength_ratios[f] * turn));
        }
      }
    }
    double s = 0;
    double s2 = 0;
    std::vector<std::complex<double>> sums(frequencies());
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Member& member : members) {
      s += member.weight * member.information;
      s2 += member.weight * member.weight * member.information;
      for (std::size_t f = 0; f < frequencies(); ++f) sums[f] += member.weight * member.phasors[f];
      middle += member.weight * member.information * member.offset;
    }
    PlainPhasePlane out;
    out.phases.resize(frequencies());
    if (s == 0) return out;
    middle /= s;
    const double prior = 1 / (growth_.slope_sigma * growth_.slope_sigma);
    Eigen::Matrix2d spread = prior * Eigen::Matrix2d::Identity();
    Eigen::Vector2d score = -prior * own.slope;
    for (const Member& member : members) {
      const Eigen::Vector2d from_middle = member.offset - middle;
      for (std::size_t f = 0; f < frequencies(); ++f) {
        const double ratio = growth_.wavelength_ratios[f];
        spread += ratio * ratio * member.weight * member.information * from_middle *
                  from_middle.transpose();
        score += ratio * member.weight * member.offset *
                 std::imag(member.phasors[f] * std::conj(sums[f]) / std::abs(sums[f]));
      }
    }
    const Eigen::Vector2d step = spread.inverse() * score;
    for (std::size_t f = 0; f < frequencies(); ++f) {
      out.phases[f] = sums[f] / std::abs(sums[f]) *
                      std::polar(1.0, -growth_.wavelength_ratios[f] * middle.dot(step));
    }
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
