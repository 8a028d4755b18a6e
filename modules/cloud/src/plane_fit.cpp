// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plane_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace tofmap {
namespace {

/// Weighted line fit along one image axis on one side of a pixel.
struct SideSlope {
  float slope = 0;     ///< of q per tangent
  float variance = 0;  ///< of the slope
  float chi2 = 0;      ///< mean squared normalised residual
  bool usable = false;
};

/// Slope of the line from the pixel through up to `radius` neighbours in direction
/// (row_step, col_step), forced through the pixel itself.
SideSlope side_slope(const InverseDepthImage& image, int row, int col, int row_step, int col_step,
                     int radius) {
  const ImageF& tangent = col_step != 0 ? image.tangent_x : image.tangent_y;
  const float q0 = image.q(row, col);
  float sum_xx = 0;
  float sum_xq = 0;
  float sum_qq = 0;
  int count = 0;
  for (int k = 1; k <= radius; ++k) {
    const int r = row + k * row_step;
    const int c = col + k * col_step;
    if (r < 0 || c < 0 || r >= image.q.rows() || c >= image.q.cols()) break;
    const float q = image.q(r, c);
    if (!std::isfinite(q)) break;
    const float weight = 1 / (image.variance(r, c) + image.variance(row, col));
    const float x = tangent(r, c) - tangent(row, col);
    const float d = q - q0;
    sum_xx += weight * x * x;
    sum_xq += weight * x * d;
    sum_qq += weight * d * d;
    ++count;
  }
  SideSlope side;
  if (count == 0) return side;
  side.usable = true;
  side.slope = sum_xq / sum_xx;
  side.variance = 1 / sum_xx;
  side.chi2 = count > 1 ? std::max(0.0F, sum_qq - sum_xq * side.slope) / (count - 1) : 1;
  return side;
}

/// Start slope along an axis: both sides where they agree, else the side that is straighter
/// (the other one crosses an edge), in case of doubt the flatter.
SideSlope start_slope(const SideSlope& back, const SideSlope& front) {
  if (!back.usable) return front;
  if (!front.usable) return back;
  const float difference = back.slope - front.slope;
  const float variance = back.variance + front.variance;
  if (difference * difference < 4 * variance) {
    SideSlope both = back;
    const float share = front.variance / variance;  // weights by inverse variance
    both.slope = share * back.slope + (1 - share) * front.slope;
    both.variance = back.variance * share;
    return both;
  }
  const auto badness = [](const SideSlope& side) {
    return std::max(side.chi2, 1.0F) * std::abs(side.slope);
  };
  return badness(back) <= badness(front) ? back : front;
}

struct Moments {
  Eigen::Matrix3f information = Eigen::Matrix3f::Zero();
  Eigen::Vector3f moment = Eigen::Vector3f::Zero();
  float sum_qq = 0;
  int count = 0;
};

/// Sums over the window's pixels whose q agrees with the plane (offset + a x + b y) within the
/// gate.
template <class Gate>
Moments accumulate(const InverseDepthImage& image, int row, int col, int radius, const Gate& in) {
  const int rows = static_cast<int>(image.q.rows());
  const int cols = static_cast<int>(image.q.cols());
  const float x0 = image.tangent_x(row, col);
  const float y0 = image.tangent_y(row, col);
  const float q_start = image.q(row, col);
  float s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0, syy = 0, sq = 0, sxq = 0, syq = 0, sqq = 0;
  int count = 0;
  for (int r = std::max(0, row - radius); r <= std::min(rows - 1, row + radius); ++r) {
    for (int c = std::max(0, col - radius); c <= std::min(cols - 1, col + radius); ++c) {
      const float d = image.q(r, c) - q_start;  // NaN fails the gate
      const float variance = image.variance(r, c);
      const float x = image.tangent_x(r, c) - x0;
      const float y = image.tangent_y(r, c) - y0;
      if (!in(d, x, y, variance)) continue;
      const float weight = 1 / variance;
      s += weight;
      sx += weight * x;
      sy += weight * y;
      sxx += weight * x * x;
      sxy += weight * x * y;
      syy += weight * y * y;
      sq += weight * d;
      sxq += weight * x * d;
      syq += weight * y * d;
      sqq += weight * d * d;
      ++count;
    }
  }
  Moments moments;
  moments.information << s, sx, sy, sx, sxx, sxy, sy, sxy, syy;
  moments.moment << sq, sxq, syq;
  moments.sum_qq = sqq;
  moments.count = count;
  return moments;
}

InverseDepthPlane solve(const Moments& moments, float q_start) {
  InverseDepthPlane plane;
  // Tangents are small numbers: scaled to unit diagonal the system is well conditioned.
  const Eigen::Vector3f scale = moments.information.diagonal().cwiseSqrt().cwiseInverse();
  if (moments.count < 3 || !scale.allFinite()) return plane;
  const Eigen::Matrix3f scaled = scale.asDiagonal() * moments.information * scale.asDiagonal();
  const Eigen::LDLT<Eigen::Matrix3f> decomposed(scaled);
  // Neighbours on one line span no plane.
  if (decomposed.vectorD().minCoeff() < 1e-3F) return plane;
  const Eigen::Vector3f solution =
      scale.asDiagonal() * decomposed.solve(scale.cwiseProduct(moments.moment));
  const Eigen::Matrix3f inverse = decomposed.solve(Eigen::Matrix3f::Identity());
  plane.neighbours = moments.count;
  plane.q0 = q_start + solution[0];
  plane.a = solution[1];
  plane.b = solution[2];
  plane.covariance = scale.asDiagonal() * inverse * scale.asDiagonal();
  // Where neighbours scatter more than predicted, the prediction is too good to be true.
  const float chi2 = moments.sum_qq - solution.dot(moments.moment);
  const float excess = chi2 / std::max(1, moments.count - 3);
  plane.covariance *= std::max(1.0F, excess);
  return plane;
}

}  // namespace

InverseDepthImage inverse_depth_image(const RangeImage& image, const PixelRays& rays) {
  InverseDepthImage out;
  out.q = 1 / (image.range_m * rays.z);
  // q = 1 / (r z_ray), so dq / dr = −q / r.
  out.variance = (image.sigma_m * out.q / image.range_m).square();
  out.tangent_x = rays.x / rays.z;
  out.tangent_y = rays.y / rays.z;
  return out;
}

InverseDepthPlane fit_plane(const InverseDepthImage& image, int row, int col,
                            const CloudOptions& options) {
  const int radius = options.window_radius_px;
  const float gate2 = static_cast<float>(options.gate_sigmas * options.gate_sigmas);
  const float q_start = image.q(row, col);
  const float variance_start = image.variance(row, col);

  const SideSlope sx = start_slope(side_slope(image, row, col, 0, -1, radius),
                                   side_slope(image, row, col, 0, 1, radius));
  const SideSlope sy = start_slope(side_slope(image, row, col, -1, 0, radius),
                                   side_slope(image, row, col, 1, 0, radius));
  const auto near_start = [&](float d, float x, float y, float variance) {
    const float error = d - sx.slope * x - sy.slope * y;
    return error * error <
           gate2 * (variance + variance_start + sx.variance * x * x + sy.variance * y * y);
  };
  Moments moments = accumulate(image, row, col, radius, near_start);
  InverseDepthPlane plane = solve(moments, q_start);

  constexpr int refinements = 2;
  for (int i = 0; i < refinements && plane.neighbours >= options.min_neighbours; ++i) {
    const float offset = plane.q0 - q_start;
    const auto near_plane = [&](float d, float x, float y, float variance) {
      const float error = d - offset - plane.a * x - plane.b * y;
      return error * error < gate2 * variance;
    };
    moments = accumulate(image, row, col, radius, near_plane);
    plane = solve(moments, q_start);
  }
  // The pixel must lie on its own plane: else it is a flying one among a surface's.
  const float own = plane.q0 - q_start;
  if (own * own > gate2 * variance_start) plane.neighbours = 0;
  return plane;
}

}  // namespace tofmap
