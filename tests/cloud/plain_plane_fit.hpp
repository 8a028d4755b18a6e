// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap::test {

/// A plane of inverse depth through a pixel; neighbours 0: there is none.
struct PlainPlane {
  int neighbours = 0;
  double q0 = 0;
  double a = 0;
  double b = 0;
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
};

/// The plane fit of surface_cloud(), a pixel at a time, in doubles.
class PlainPlaneFit {
 public:
  PlainPlaneFit(const RangeImage& image, const PixelRays& rays, const CloudOptions& options)
      : q_((1 / (image.range_m * rays.z)).cast<double>()),
        variance_((image.sigma_m * q_.cast<float>() / image.range_m).square().cast<double>()),
        x_((rays.x / rays.z).cast<double>()),
        y_((rays.y / rays.z).cast<double>()),
        options_(options) {}

  PlainPlane fit(int row, int col) const {
    const Line along_x = start_line(line(row, col, 0, -1), line(row, col, 0, 1));
    const Line along_y = start_line(line(row, col, -1, 0), line(row, col, 1, 0));
    Eigen::Vector3d plane(0, along_x.slope, along_y.slope);
    Eigen::Vector3d slack(variance_(row, col), along_x.variance, along_y.variance);
    PlainPlane out;
    for (int pass = 0; pass < 3; ++pass) {
      out = weighted_fit(row, col, near(row, col, plane, slack), plane);
      if (out.neighbours < options_.min_neighbours) return {};
      slack.setZero();
    }
    const double gate2 = options_.gate_sigmas * options_.gate_sigmas;
    return plane[0] * plane[0] <= gate2 * variance_(row, col) ? out : PlainPlane{};
  }

 private:
  struct Line {
    bool is_usable = false;
    double slope = 0;
    double variance = 0;
    double badness = 0;
  };
  struct Neighbour {
    int row;
    int col;
  };

  bool is_inside(int row, int col) const {
    return row >= 0 && col >= 0 && row < q_.rows() && col < q_.cols();
  }

  Line line(int row, int col, int down, int right) const {
    double xx = 0;
    double xq = 0;
    double qq = 0;
    int count = 0;
    for (int k = 1; k <= options_.window_radius_px; ++k) {
      const int r = row + k * down;
      const int c = col + k * right;
      if (!is_inside(r, c) || std::isnan(q_(r, c))) break;
      const double weight = 1 / (variance_(r, c) + variance_(row, col));
      const double x = right != 0 ? x_(r, c) - x_(row, col) : y_(r, c) - y_(row, col);
      const double d = q_(r, c) - q_(row, col);
      xx += weight * x * x;
      xq += weight * x * d;
      qq += weight * d * d;
      ++count;
    }
    if (count == 0) return {};
    const double slope = xq / xx;
    const double scatter = count > 1 ? (qq - xq * slope) / (count - 1) : 1;
    return {true, slope, 1 / xx, std::max(scatter, 1.0) * std::abs(slope)};
  }

  static Line start_line(const Line& back, const Line& front) {
    if (!back.is_usable) return front;
    if (!front.is_usable) return back;
    const double difference = back.slope - front.slope;
    const double sum = back.variance + front.variance;
    if (difference * difference >= 4 * sum) return back.badness <= front.badness ? back : front;
    const double share = front.variance / sum;
    return {true, share * back.slope + (1 - share) * front.slope, share * back.variance, 0};
  }

  std::vector<Neighbour> near(int row, int col, const Eigen::Vector3d& plane,
                              const Eigen::Vector3d& slack) const {
    std::vector<Neighbour> found;
    const int radius = options_.window_radius_px;
    for (int r = row - radius; r <= row + radius; ++r) {
      for (int c = col - radius; c <= col + radius; ++c) {
        if (!is_inside(r, c) || std::isnan(q_(r, c))) continue;
        const double x = x_(r, c) - x_(row, col);
        const double y = y_(r, c) - y_(row, col);
        const double error = q_(r, c) - q_(row, col) - plane.dot(Eigen::Vector3d(1, x, y));
        const double variance = variance_(r, c) + slack.dot(Eigen::Vector3d(1, x * x, y * y));
        if (error * error < options_.gate_sigmas * options_.gate_sigmas * variance) {
          found.push_back({r, c});
        }
      }
    }
    return found;
  }

  PlainPlane weighted_fit(int row, int col, const std::vector<Neighbour>& neighbours,
                          Eigen::Vector3d& plane) const {
    const auto count = static_cast<Eigen::Index>(neighbours.size());
    if (count < 3) return {};
    Eigen::MatrixX3d terms(count, 3);
    Eigen::VectorXd values(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto [r, c] = neighbours[static_cast<std::size_t>(i)];
      const double sigma = std::sqrt(variance_(r, c));
      terms.row(i) << 1 / sigma, (x_(r, c) - x_(row, col)) / sigma,
          (y_(r, c) - y_(row, col)) / sigma;
      values[i] = (q_(r, c) - q_(row, col)) / sigma;
    }
    const Eigen::Matrix3d information = terms.transpose() * terms;
    plane = information.ldlt().solve(terms.transpose() * values);
    const double chi2 = (terms * plane - values).squaredNorm();
    const double excess = std::max(1.0, chi2 / std::max<double>(1, static_cast<double>(count) - 3));
    PlainPlane out{static_cast<int>(count), q_(row, col) + plane[0], plane[1], plane[2], {}};
    out.variances = excess * information.inverse().diagonal();
    return out;
  }

  Image<double> q_;
  Image<double> variance_;
  Image<double> x_;
  Image<double> y_;
  CloudOptions options_;
};

}  // namespace tofmap::test
