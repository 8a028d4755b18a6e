// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_model.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace tofmap {

void WrapCountModel::resize(int rows, int cols, int counts) {
  if (layout_.rows() != rows || layout_.cols() != cols) layout_ = DiagonalLayout(rows, cols);
  counts_ = counts;
  evidence_.resize(layout_.size(static_cast<std::size_t>(counts)));
  for (std::vector<float>* plane : {&right_.same, &right_.next, &down_.same, &down_.next}) {
    plane->assign(layout_.size(1), 0.0F);
  }
}

/// Makes the unary factors of mixed pixels nearly uniform, since their residual is that of neither
/// surface.
void WrapCountModel::mark_mixed_pixels(const ImageU8& mixed) {
  for (int v = 0; v < layout_.rows(); ++v) {
    for (int u = 0; u < layout_.cols(); ++u) {
      if (mixed(v, u) == 0) continue;
      measured_.outlier_share[layout_.place(u + v, v, 1)] = mixed_outlier_share;
    }
  }
}

/// Stores the measurements of a frame diagonal by diagonal.
void WrapCountModel::load(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                          const std::vector<double>& residual_sigma_m) {
  const auto rows = static_cast<int>(frame.rows());
  const auto cols = static_cast<int>(frame.cols());
  for (std::size_t f = 0; f < frame.frequencies(); ++f) {
    const auto wavelength_m = static_cast<float>(limits.wavelengths_m[f]);
    const auto systematic_m2 = static_cast<float>(residual_sigma_m[f] * residual_sigma_m[f]);
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        if (std::isnan(frame.phases[f](v, u))) continue;
        const std::size_t at = layout_.place(u + v, v, 1);
        const float sigma_m = sigma.cycles[f](v, u) * wavelength_m;
        measured_.phases[f][at] = frame.phases[f](v, u);
        measured_.variances_m2[f][at] = sigma_m * sigma_m + systematic_m2;
        if (f == 0 && frame.has_amplitude()) measured_.amplitude[at] = frame.amplitudes[0](v, u);
      }
    }
  }
}

void WrapCountModel::assign(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                            const std::vector<double>& residual_sigma_m,
                            const WrapCountPrior& prior) {
  resize(static_cast<int>(frame.rows()), static_cast<int>(frame.cols()), limits.count);
  measured_.assign(layout_.size(1), frame.frequencies(), static_cast<float>(prior.outlier_share));
  load(frame, limits, sigma, residual_sigma_m);
  if (prior.mixed_pixels && frame.has_amplitude()) {
    mark_mixed_pixels(mixed_pixels(frame.amplitudes[0], sigma.cycles[0]));
  }
  fill_unary(limits);
  fill_pairwise(limits, prior);
}

void WrapCountModel::fill_unary(const UnwrapLimits& limits) {
  const auto counts = static_cast<std::size_t>(counts_);
  const UnaryFactors factors(limits);
  for (int d = 0; d < layout_.diagonals(); ++d) {
    const int first = layout_.begin(d);
    factors.fill(measured_, layout_.place(d, first, 1),
                 DiagonalLayout::whole_vectors(layout_.end(d) - first),
                 &evidence_[layout_.place(d, first, counts)], layout_.plane_step(d));
  }
}

void WrapCountModel::fill_pairwise(const UnwrapLimits& limits, const WrapCountPrior& prior) {
  const EdgeScale scale(limits, prior);
  const auto pixels = [&](int d, int row) { return PixelsAt{measured_, layout_.place(d, row, 1)}; };
  for (int d = 0; d + 1 < layout_.diagonals(); ++d) {
    const int first = layout_.begin(d);
    const int count = DiagonalLayout::whole_vectors(layout_.end(d) - first);
    const std::size_t edge = layout_.place(d, first, 1);
    fill_pairwise_factors(pixels(d, first), pixels(d + 1, first), count, scale, &right_.same[edge],
                          &right_.next[edge]);
    fill_pairwise_factors(pixels(d, first), pixels(d + 1, first + 1), count, scale,
                          &down_.same[edge], &down_.next[edge]);
  }
}

void WrapCountModel::weigh_evidence(int row, int col, std::span<const float> factors) {
  const std::size_t place = layout_.place(row + col, row, static_cast<std::size_t>(counts_));
  const std::size_t step = layout_.plane_step(row + col);
  const auto weighed = [&](std::size_t n) {
    return to_float(evidence_[place + n * step]) * factors[n];
  };
  float best = 0;
  for (std::size_t n = 0; n < factors.size(); ++n) best = std::max(best, weighed(n));
  for (std::size_t n = 0; n < factors.size(); ++n) {
    evidence_[place + n * step] = to_bfloat16(std::max(weighed(n) / best, least_unary_factor));
  }
}

std::vector<double> WrapCountModel::evidence_of(int row, int col) const {
  const auto counts = static_cast<std::size_t>(counts_);
  std::size_t at = layout_.place(row + col, row, counts);
  std::vector<double> evidence;
  for (std::size_t n = 0; n < counts; ++n, at += layout_.plane_step(row + col)) {
    evidence.push_back(to_float(evidence_[at]));
  }
  return evidence;
}

}  // namespace tofmap
