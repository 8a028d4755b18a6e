// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_model.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Upper bound of the pairwise factors. It bounds the messages, so that products of messages do not
/// overflow or underflow.
constexpr float largest_ratio = 1e12F;

/// Smallest unary factor, also that of ranges beyond the limits.
constexpr float impossible = 1e-8F;

/// The measurements of successive pixels on one diagonal.
struct Pixels {
  int rows;
  const float* phase_a;
  const float* phase_b;
  const float* amplitude;
  const float* variance_a_m2;
  const float* variance_b_m2;
  const float* outlier_share;
};

struct EvidenceScale {
  double wavelength_ratio;  ///< of A to B
  float wavelength_b_m;
  float farthest_cycles_a;
};

/// Number of pixels whose unary factors are computed at a time.
constexpr int evidence_rows = 4 * DiagonalLayout::lanes;

/// How sharply the residual of each pixel is distributed around its true value.
struct Sharpness {
  std::array<float, evidence_rows> precision;  ///< 1 / variance of the residual, 1 / cycles²
  std::array<float, evidence_rows> height;     ///< density of the residual at the true wrap count
};

/// Returns the smallest precision among the pixels whose residual is informative.
TOFMAP_VECTOR_CLONES float fill_sharpness(const Pixels& pixels_, const EvidenceScale& scale,
                                          Sharpness& out) {
  const Pixels pixels = pixels_;
  const float squared_b = scale.wavelength_b_m * scale.wavelength_b_m;
  float* precision = out.precision.data();
  float* height = out.height.data();
  constexpr float least_telling = 1e-3F;  // a noise of thirty cycles of B
  std::array<float, DiagonalLayout::lanes> least;
  least.fill(largest_ratio);
  for (int i = 0; i < pixels.rows; i += DiagonalLayout::lanes) {
#pragma GCC ivdep
    for (int k = 0; k < DiagonalLayout::lanes; ++k) {
      const float variance = pixels.variance_a_m2[i + k] + pixels.variance_b_m2[i + k];
      const float sharp = squared_b / variance;
      precision[i + k] = sharp;
      height[i + k] = std::sqrt(sharp * (0.5F / std::numbers::pi_v<float>));
      const float counted = sharp > least_telling ? sharp : largest_ratio;
      float& lane = least[static_cast<std::size_t>(k)];
      lane = counted < lane ? counted : lane;
    }
  }
  return least_of(least);
}

/// Equation 11: the unary factors of each pixel from its residual. `passes` states that the noise
/// of the residual may exceed half a cycle of B, so that the nearest other wrap of B matters, too.
template <bool passes>
[[gnu::always_inline]] inline void fill_evidence_of(const Pixels& pixels,
                                                    const EvidenceScale& scale, int counts,
                                                    const Sharpness& sharpness, BFloat16* evidence,
                                                    std::size_t step) {
  const int rows = pixels.rows;
  const float* precision = sharpness.precision.data();
  const float* height = sharpness.height.data();
  std::array<float, evidence_rows> best{};
  const auto ratio = static_cast<float>(scale.wavelength_ratio);
  for (int k = 0; k < counts; ++k) {
    BFloat16* at = evidence + static_cast<std::size_t>(k) * step;
    // Cycles of B in k wavelengths of A, reduced to −1/2 … 1/2, so that wrap counts which the pair
    // cannot tell apart get the same unary factor to the last bit.
    const auto shift = static_cast<float>(residual_shift_cycles(scale.wavelength_ratio, k));
    const float farthest = k == 0 ? 1 : scale.farthest_cycles_a - static_cast<float>(k);
#pragma GCC ivdep
    for (int i = 0; i < rows; ++i) {
      const float offset = to_half_cycle(pixels.phase_a[i] * ratio + shift - pixels.phase_b[i]);
      const float size = offset < 0 ? -offset : offset;
      // Density of the residual, up to the factor `height`. An outlier has density 1 per cycle.
      float density = exp_of_negative(-0.5F * precision[i] * size * size);
      if constexpr (passes) {
        const float other = 1 - size;
        density += exp_of_negative(-0.5F * precision[i] * other * other);
      }
      const float outlier = pixels.outlier_share[i];
      const float likelihood = outlier + (1 - outlier) * height[i] * density;
      const float within = pixels.phase_a[i] <= farthest ? 1.0F : 0.0F;
      const float value = within * likelihood;
      at[i] = to_bfloat16(value);
      best[static_cast<std::size_t>(i)] =
          value > best[static_cast<std::size_t>(i)] ? value : best[static_cast<std::size_t>(i)];
    }
  }
  for (int i = 0; i < rows; ++i) {
    best[static_cast<std::size_t>(i)] = 1 / best[static_cast<std::size_t>(i)];
  }
  for (int k = 0; k < counts; ++k) {
    BFloat16* at = evidence + static_cast<std::size_t>(k) * step;
#pragma GCC ivdep
    for (int i = 0; i < rows; ++i) {
      const float share = to_float(at[i]) * best[static_cast<std::size_t>(i)];
      const float squared = share * share;
      const float tempered = squared * squared;
      at[i] = to_bfloat16(tempered > impossible ? tempered : impossible);
    }
  }
}

TOFMAP_VECTOR_CLONES void fill_evidence(const Pixels& pixels, const EvidenceScale& scale,
                                        int counts, const Sharpness& sharpness, BFloat16* evidence,
                                        std::size_t step) {
  fill_evidence_of<true>(Pixels(pixels), EvidenceScale(scale), counts, sharpness, evidence, step);
}

TOFMAP_VECTOR_CLONES void fill_sharp_evidence(const Pixels& pixels, const EvidenceScale& scale,
                                              int counts, const Sharpness& sharpness,
                                              BFloat16* evidence, std::size_t step) {
  fill_evidence_of<false>(Pixels(pixels), EvidenceScale(scale), counts, sharpness, evidence, step);
}

/// Amplitudes of pixels and their four neighbours.
struct Cross {
  const float* here;
  const float* left;
  const float* right;
  const float* above;
  const float* below;
};

/// How far an amplitude lies inside the interval between those of two opposite neighbours: the
/// difference from the nearer one. Negative if it lies outside.
[[gnu::always_inline]] inline float depth_between(float one, float here, float other) {
  const float from_one = here - one;
  const float to_other = other - here;
  const float lesser = from_one < to_other ? from_one : to_other;
  const float greater = from_one < to_other ? to_other : from_one;
  return lesser > -greater ? lesser : -greater;
}

/// Finds mixed pixels: 1 in `mixed`, else 0.
TOFMAP_VECTOR_CLONES void find_mixed(int count, const Cross& cross_, const float* sigma_cycles,
                                     float* mixed) {
  constexpr float least_contrast = 0.05F;  // shading changes less from pixel to pixel
  constexpr float sigmas =
      2.5F * std::numbers::sqrt2_v<float>;  // for a difference of two amplitudes
  // The relative noise of an amplitude equals the noise of its phase in radians.
  constexpr float per_sigma = sigmas * 2 * std::numbers::pi_v<float>;
  const Cross cross = cross_;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float here = cross.here[i];
    const float contrast = least_contrast * here;
    const float noise = per_sigma * sigma_cycles[i] * here;
    const float step = contrast > noise ? contrast : noise;
    const float across = depth_between(cross.left[i], here, cross.right[i]);
    const float along = depth_between(cross.above[i], here, cross.below[i]);
    mixed[i] = (across > along ? across : along) > step ? 1.0F : 0.0F;
  }
}

struct EdgeScale {
  float wavelength_a_m;
  float slope_m2;
  float edge_share;
  float edge_density;  ///< density of the range difference between surfaces, 1 / m
  float amplitude_weight;
};

/// Equations 12 to 14: the pairwise factors between pixels and their neighbours.
TOFMAP_VECTOR_CLONES void fill_edges(const Pixels& from, const Pixels& to, const EdgeScale& scale,
                                     float* same, float* next) {
  const float* phase_from = from.phase_a;
  const float* phase_to = to.phase_a;
  const float* variance_from = from.variance_a_m2;
  const float* variance_to = to.variance_a_m2;
  const float* amplitude_from = from.amplitude;
  const float* amplitude_to = to.amplitude;
#pragma GCC ivdep
  for (int i = 0; i < from.rows; ++i) {
    const float difference = phase_to[i] - phase_from[i];
    const float toward = difference > 0 ? -1.0F : 1.0F;
    const float spread_m = std::sqrt(variance_from[i] + variance_to[i] + scale.slope_m2);
    const float lesser = amplitude_from[i] < amplitude_to[i] ? amplitude_from[i] : amplitude_to[i];
    const float greater = amplitude_from[i] < amplitude_to[i] ? amplitude_to[i] : amplitude_from[i];
    const float likeness =
        scale.amplitude_weight * (lesser / greater) + (1 - scale.amplitude_weight);
    const float edge = 1 - (1 - scale.edge_share) * likeness;
    const float other = edge * scale.edge_density;
    const auto ratio = [&](float cycles) {
      const float deviation = (cycles < 0 ? -cycles : cycles) * scale.wavelength_a_m / spread_m;
      const float surface = exp_of_negative(-deviation) / (2 * spread_m);
      const float r = ((1 - edge) * surface + other) / other;
      const float squared = r * r;
      const float tempered = squared * squared;
      return (tempered < largest_ratio ? tempered : largest_ratio) - 1;
    };
    const float ratio_same = ratio(difference);
    const float ratio_next = ratio(difference + toward);
    // Pixels without a return have a very large variance: they tell their neighbours nothing.
    const float present = variance_from[i] + variance_to[i] < largest_ratio ? 1.0F : 0.0F;
    same[i] = present * (ratio_same > 0 ? ratio_same : 0.0F);
    next[i] = present * toward * (ratio_next > 0 ? ratio_next : 0.0F);
  }
}

}  // namespace

void WrapCountModel::resize(int rows, int cols, int counts) {
  if (layout_.rows() != rows || layout_.cols() != cols) layout_ = DiagonalLayout(rows, cols);
  counts_ = counts;
  evidence_.resize(layout_.size(static_cast<std::size_t>(counts)));
  for (std::vector<float>* plane :
       {&right_.same, &right_.next, &down_.same, &down_.next, &phase_a_, &phase_b_}) {
    plane->assign(layout_.size(1), 0.0F);
  }
  amplitude_.assign(layout_.size(1), 1.0F);
  for (std::vector<float>* plane : {&variance_a_m2_, &variance_b_m2_}) {
    plane->assign(layout_.size(1), 4 * largest_ratio);
  }
}

/// Makes the unary factors of mixed pixels nearly uniform, since their residual is that of neither
/// surface. Pixels at the border of the image are never taken for mixed.
void WrapCountModel::mark_mixed_pixels(const ImageF& amplitude, const ImageF& sigma_cycles) {
  constexpr float flat = 0.999F;
  const auto rows = static_cast<int>(amplitude.rows());
  const auto cols = static_cast<int>(amplitude.cols());
  std::vector<float> mixed(static_cast<std::size_t>(std::max(cols, 2)));
  for (int v = 1; v + 1 < rows; ++v) {
    const float* here = amplitude.data() + v * cols + 1;
    find_mixed(cols - 2, {here, here - 1, here + 1, here - cols, here + cols},
               sigma_cycles.data() + v * cols + 1, mixed.data());
    for (int u = 1; u + 1 < cols; ++u) {
      if (mixed[static_cast<std::size_t>(u - 1)] == 0) continue;
      outlier_share_[layout_.place(u + v, v, 1)] = flat;
    }
  }
}

void WrapCountModel::assign(const DualFrequencyFrame& frame, const UnwrapLimits& limits,
                            const PhaseSigma& sigma, double residual_sigma_m,
                            const WrapCountPrior& prior) {
  const auto rows = static_cast<int>(frame.phase_a.rows());
  const auto cols = static_cast<int>(frame.phase_a.cols());
  resize(rows, cols, limits.count_a);
  const auto wavelength_a = static_cast<float>(limits.wavelength_a_m);
  const auto wavelength_b = static_cast<float>(limits.wavelength_b_m);
  const auto residual_variance_m2 = static_cast<float>(residual_sigma_m * residual_sigma_m);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const float a = frame.phase_a(v, u);
      const float b = frame.phase_b(v, u);
      if (std::isnan(a) || std::isnan(b)) continue;
      const std::size_t at = layout_.place(u + v, v, 1);
      const float sigma_a_m = sigma.a_cycles(v, u) * wavelength_a;
      const float sigma_b_m = sigma.b_cycles(v, u) * wavelength_b;
      phase_a_[at] = a;
      phase_b_[at] = b;
      if (frame.has_amplitude()) amplitude_[at] = frame.amplitude_a(v, u);
      variance_a_m2_[at] = sigma_a_m * sigma_a_m;
      variance_b_m2_[at] = sigma_b_m * sigma_b_m + residual_variance_m2;
    }
  }

  outlier_share_.assign(layout_.size(1), static_cast<float>(prior.outlier_share));
  if (prior.mixed_pixels && frame.has_amplitude())
    mark_mixed_pixels(frame.amplitude_a, sigma.a_cycles);

  const auto pixels = [&](int d, int row, int count) {
    const std::size_t at = layout_.place(d, row, 1);
    return Pixels{count,
                  &phase_a_[at],
                  &phase_b_[at],
                  &amplitude_[at],
                  &variance_a_m2_[at],
                  &variance_b_m2_[at],
                  &outlier_share_[at]};
  };
  const EvidenceScale evidence_scale{
      limits.wavelength_a_m / limits.wavelength_b_m, wavelength_b,
      static_cast<float>(limits.max_range_m / limits.wavelength_a_m + 0.05)};
  const EdgeScale edge_scale{wavelength_a, static_cast<float>(prior.slope_m * prior.slope_m),
                             static_cast<float>(prior.edge_share),
                             static_cast<float>(1 / (2 * prior.edge_reach_m)),
                             prior.amplitude_edges ? 1.0F : 0.0F};
  const auto counts = static_cast<std::size_t>(counts_);
  Sharpness sharpness;
  for (int d = 0; d < layout_.diagonals(); ++d) {
    const int first = layout_.begin(d);
    const int count = DiagonalLayout::whole_vectors(layout_.end(d) - first);
    for (int done = 0; done < count; done += evidence_rows) {
      const Pixels block = pixels(d, first + done, std::min(evidence_rows, count - done));
      BFloat16* evidence = &evidence_[layout_.place(d, first + done, counts)];
      // Above this precision, half a cycle is more than seven standard deviations, and the nearest
      // other wrap of B has a density that is lost in rounding.
      constexpr float sharp = 200;
      const bool is_sharp = fill_sharpness(block, evidence_scale, sharpness) > sharp;
      (is_sharp ? fill_sharp_evidence : fill_evidence)(block, evidence_scale, counts_, sharpness,
                                                       evidence, layout_.plane_step(d));
    }
    const Pixels here = pixels(d, first, count);
    if (d + 1 == layout_.diagonals()) break;
    const std::size_t edge = layout_.place(d, first, 1);
    fill_edges(here, pixels(d + 1, first, count), edge_scale, &right_.same[edge],
               &right_.next[edge]);
    fill_edges(here, pixels(d + 1, first + 1, count), edge_scale, &down_.same[edge],
               &down_.next[edge]);
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
    evidence_[place + n * step] = to_bfloat16(std::max(weighed(n) / best, impossible));
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
