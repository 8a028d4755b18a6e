// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/kernel_density.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap::peers {
namespace {

using Densities = std::array<ImageF, most_hypotheses>;

/// Gaussian weights of the offsets 0 … radius in one direction.
std::vector<float> spatial_weights(int radius, double sigma) {
  std::vector<float> weights;
  for (int i = 0; i <= radius; ++i)
    weights.push_back(static_cast<float>(std::exp(-0.5 * i * i / (sigma * sigma))));
  return weights;
}

/// Pointers to the hypotheses of a row, the first pixel of which may lie in the margin.
struct Row {
  std::array<const float*, most_hypotheses> range{};
  std::array<const float*, most_hypotheses> weight{};
  std::array<float*, most_hypotheses> density{};
};

/// The kernel. It is never so small that products with weights are denormal, which are slow.
[[gnu::always_inline]] inline float kernel(float range, float other) {
  const float difference = range - other;
  const float exponent = -difference * difference;
  return exp_of_negative(exponent > -40 ? exponent : -40.0F);
}

template <std::size_t count>
[[gnu::always_inline]] inline void add_own_row(Eigen::Index cols, const Row& row) {
  const auto [r0, r1, r2] = row.range;
  const auto [w0, w1, w2] = row.weight;
  const auto [d0, d1, d2] = row.density;
#pragma GCC ivdep
  for (Eigen::Index u = 0; u < cols; ++u) {
    const float kernel_01 = kernel(r0[u], r1[u]);
    float sum_0 = w0[u] + w1[u] * kernel_01;
    float sum_1 = w1[u] + w0[u] * kernel_01;
    if constexpr (count == 3) {
      const float kernel_02 = kernel(r0[u], r2[u]);
      const float kernel_12 = kernel(r1[u], r2[u]);
      sum_0 += w2[u] * kernel_02;
      sum_1 += w2[u] * kernel_12;
      d2[u] += w2[u] + w0[u] * kernel_02 + w1[u] * kernel_12;
    }
    d0[u] += sum_0;
    d1[u] += sum_1;
  }
}

/// Adds what the pixels of `here` and those of `there`, at the same positions of the rows, give to
/// each other. The kernel is symmetric, so it is computed once for both directions.
template <std::size_t count>
[[gnu::always_inline]] inline void exchange_rows(Eigen::Index cols, float spatial, const Row& here,
                                                 const Row& there) {
  const auto [r0, r1, r2] = here.range;
  const auto [w0, w1, w2] = here.weight;
  const auto [d0, d1, d2] = here.density;
  const auto [s0, s1, s2] = there.range;
  const auto [x0, x1, x2] = there.weight;
  const auto [e0, e1, e2] = there.density;
#pragma GCC ivdep
  for (Eigen::Index u = 0; u < cols; ++u) {
    const float k00 = kernel(r0[u], s0[u]);
    const float k01 = kernel(r0[u], s1[u]);
    const float k10 = kernel(r1[u], s0[u]);
    const float k11 = kernel(r1[u], s1[u]);
    float to_d0 = x0[u] * k00 + x1[u] * k01;
    float to_d1 = x0[u] * k10 + x1[u] * k11;
    float to_e0 = w0[u] * k00 + w1[u] * k10;
    float to_e1 = w0[u] * k01 + w1[u] * k11;
    if constexpr (count == 3) {
      const float k02 = kernel(r0[u], s2[u]);
      const float k12 = kernel(r1[u], s2[u]);
      const float k20 = kernel(r2[u], s0[u]);
      const float k21 = kernel(r2[u], s1[u]);
      const float k22 = kernel(r2[u], s2[u]);
      to_d0 += x2[u] * k02;
      to_d1 += x2[u] * k12;
      to_e0 += w2[u] * k20;
      to_e1 += w2[u] * k21;
      d2[u] += spatial * (x0[u] * k20 + x1[u] * k21 + x2[u] * k22);
      e2[u] += spatial * (w0[u] * k02 + w1[u] * k12 + w2[u] * k22);
    }
    d0[u] += spatial * to_d0;
    d1[u] += spatial * to_d1;
    e0[u] += spatial * to_e0;
    e1[u] += spatial * to_e1;
  }
}

TOFMAP_VECTOR_CLONES void add_own(int count, Eigen::Index cols, const Row& row) {
  if (count == 2)
    add_own_row<2>(cols, row);
  else
    add_own_row<3>(cols, row);
}

TOFMAP_VECTOR_CLONES void exchange(int count, Eigen::Index cols, float spatial, const Row& here,
                                   const Row& there) {
  if (count == 2)
    exchange_rows<2>(cols, spatial, here, there);
  else
    exchange_rows<3>(cols, spatial, here, there);
}

Row row_of(const RangeHypotheses& hypotheses, Densities& densities, Eigen::Index v,
           Eigen::Index u) {
  Row row;
  for (std::size_t i = 0; i < static_cast<std::size_t>(hypotheses.count); ++i) {
    row.range[i] = &hypotheses.range[i](v, u);
    row.weight[i] = &hypotheses.weight[i](v, u);
    row.density[i] = &densities[i](v, u);
  }
  return row;
}

/// The sum of the weights around each pixel. Columns within the margins are not filled.
ImageF total_weights(const RangeHypotheses& hypotheses, const std::vector<float>& spatial) {
  const Eigen::Index rows = hypotheses.range[0].rows();
  const Eigen::Index cols = hypotheses.range[0].cols();
  const Eigen::Index margin = hypotheses.margin;
  ImageF sum = hypotheses.weight[0] + hypotheses.weight[1];
  if (hypotheses.count == 3) sum += hypotheses.weight[2];
  ImageF across = sum;
  const auto radius = static_cast<Eigen::Index>(spatial.size()) - 1;
  for (Eigen::Index i = 1; i <= radius; ++i)
    across.middleCols(margin, cols - 2 * margin) +=
        spatial[static_cast<std::size_t>(i)] * (sum.middleCols(margin - i, cols - 2 * margin) +
                                                sum.middleCols(margin + i, cols - 2 * margin));
  ImageF total = across;
  for (Eigen::Index i = 1; i <= std::min(radius, rows - 1); ++i) {
    const float weight = spatial[static_cast<std::size_t>(i)];
    total.topRows(rows - i) += weight * across.bottomRows(rows - i);
    total.bottomRows(rows - i) += weight * across.topRows(rows - i);
  }
  return total;
}

}  // namespace

Densities kernel_densities(const RangeHypotheses& hypotheses, int support_radius_px,
                           double spatial_sigma_px, double least_total_weight) {
  const Eigen::Index rows = hypotheses.range[0].rows();
  const Eigen::Index margin = hypotheses.margin;
  const Eigen::Index cols = hypotheses.range[0].cols() - 2 * margin;
  const Eigen::Index radius = support_radius_px;
  const std::vector<float> spatial = spatial_weights(support_radius_px, spatial_sigma_px);
  Densities densities;
  Densities from_before;  // what a pixel gets from those before it, in order of rows and columns
  for (std::size_t i = 0; i < static_cast<std::size_t>(hypotheses.count); ++i) {
    densities[i].setZero(rows, cols + 2 * margin);
    from_before[i].setZero(rows, cols + 2 * margin);
  }
  for (Eigen::Index v = 0; v < rows; ++v) {
    const Row here = row_of(hypotheses, densities, v, margin);
    add_own(hypotheses.count, cols, here);
    for (Eigen::Index dv = 0; dv <= std::min(radius, rows - 1 - v); ++dv) {
      for (Eigen::Index du = dv == 0 ? 1 : -radius; du <= radius; ++du) {
        const float weight =
            spatial[static_cast<std::size_t>(dv)] * spatial[static_cast<std::size_t>(std::abs(du))];
        exchange(hypotheses.count, cols, weight, here,
                 row_of(hypotheses, from_before, v + dv, margin + du));
      }
    }
  }
  const ImageF total =
      total_weights(hypotheses, spatial).max(static_cast<float>(least_total_weight));
  for (std::size_t i = 0; i < static_cast<std::size_t>(hypotheses.count); ++i)
    densities[i] = (densities[i] + from_before[i]) / total;
  return densities;
}

}  // namespace tofmap::peers
