// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plane_windows.hpp"

#include <algorithm>
#include <cmath>

namespace tofmap {
namespace {

/// The window radius after `widenings` doublings.
int widened_radius_px(const CloudOptions& options, int widenings) {
  const int largest = std::max(options.window_radius_px, options.max_window_radius_px);
  return std::min(options.window_radius_px << widenings, largest);
}

/// Difference of the tangents of two neighbouring pixels in the middle of the image.
float tangent_pitch(const PixelRays& rays) {
  const Eigen::Index row = rays.x.rows() / 2;
  const Eigen::Index col = rays.x.cols() / 2;
  if (col < 1) return 1;
  return rays.x(row, col) / rays.z(row, col) - rays.x(row, col - 1) / rays.z(row, col - 1);
}

/// Standard deviation of the tilt, in radians per unit of relative noise, of a plane that is seen
/// head on and fitted to a full window: the slope has the variance σ² / Σ x².
float tilt_by_noise(int radius_px, float pitch) {
  const auto side = static_cast<float>(2 * radius_px + 1);
  const float sum_x2 = side * side * (side * side - 1) / 12;
  return 1 / (pitch * std::sqrt(sum_x2));
}

/// Number of doublings of each pixel's window radius.
ImageU8 widenings_of(const RangeImage& image, const PixelRays& rays, const CloudOptions& options) {
  const int largest = widened_radius_px(options, 8);
  const float pitch = tangent_pitch(rays);
  std::vector<float> most_noise;  // largest relative noise for which each radius is enough
  for (int k = 0; widened_radius_px(options, k) < largest; ++k) {
    most_noise.push_back(static_cast<float>(options.max_normal_sigma_rad) /
                         tilt_by_noise(widened_radius_px(options, k), pitch));
  }
  ImageU8 widenings = ImageU8::Zero(image.rows(), image.cols());
  for (Eigen::Index row = 0; row < image.rows(); ++row) {
    for (Eigen::Index col = 0; col < image.cols(); ++col) {
      const float noise =
          image.sigma_m(row, col) / image.range_m(row, col) * std::sqrt(image.averaged(row, col));
      for (const float most : most_noise) widenings(row, col) += noise > most ? 1 : 0;
    }
  }
  return widenings;
}

void copy_plane(const PlaneRow& from, std::size_t i, PlaneRow& to) {
  to.neighbours[i] = from.neighbours[i];
  to.q0[i] = from.q0[i];
  to.a[i] = from.a[i];
  to.b[i] = from.b[i];
  to.q0_variance[i] = from.q0_variance[i];
  to.a_variance[i] = from.a_variance[i];
  to.b_variance[i] = from.b_variance[i];
  to.excess[i] = from.excess[i];
}

}  // namespace

PlaneWindows::PlaneWindows(const RangeImage& image, const PixelRays& rays,
                           const CloudOptions& options)
    : cols_(static_cast<int>(image.cols())),
      widenings_(widenings_of(image, rays, options)),
      averaged_px_(image.averaged_px) {
  if (averaged_px_.size() > 0) relative_variance_ = (image.sigma_m / image.range_m).square();
  const int most = widenings_.size() > 0 ? widenings_.maxCoeff() : 0;
  for (int k = 0; k <= most; ++k) {
    CloudOptions widened = options;
    widened.window_radius_px = widened_radius_px(options, k);
    fits_.emplace_back(image, rays, widened);
  }
}

void PlaneWindows::fit(int row, PlaneRow& out) const {
  fits_.front().fit(row, out);
  if (fits_.size() > 1) {
    PlaneRow wider(static_cast<std::size_t>(cols_));
    for (std::size_t k = 1; k < fits_.size(); ++k) {
      if (!(widenings_.row(row) == static_cast<std::uint8_t>(k)).any()) continue;
      fits_[k].fit(row, wider);
      take_wider(row, k, wider, out);
    }
  }
  const float* averaged = averaged_px_.size() > 0 ? &averaged_px_(row, 0) : nullptr;
  for (std::size_t k = 0; k < fits_.size(); ++k) {
    std::vector<int> columns;
    for (int col = 0; col < cols_; ++col) {
      if (widenings_(row, col) == k) columns.push_back(col);
    }
    fits_[k].refit_folds(row, columns, averaged, out);
  }
  if (averaged != nullptr) count_shared_noise(row, out);
}

void PlaneWindows::take_wider(int row, std::size_t widenings, const PlaneRow& wider,
                              PlaneRow& out) const {
  for (int col = 0; col < cols_; ++col) {
    if (widenings_(row, col) == widenings) copy_plane(wider, static_cast<std::size_t>(col), out);
  }
}

void PlaneWindows::count_shared_noise(int row, PlaneRow& out) const {
  for (int col = 0; col < cols_; ++col) {
    const auto i = static_cast<std::size_t>(col);
    if (out.neighbours[i] == 0 || !(averaged_px_(row, col) > 1)) continue;
    // A fit to averaged pixels is at most as uncertain as a single one of them.
    const float own_variance = relative_variance_(row, col) * out.q0[i] * out.q0[i];
    out.q0_variance[i] = std::min(averaged_px_(row, col) * out.q0_variance[i],
                                  std::max(own_variance, out.q0_variance[i]));
    out.a_variance[i] *= averaged_px_(row, col);
    out.b_variance[i] *= averaged_px_(row, col);
  }
}

}  // namespace tofmap
