// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/joint/wrap_count_factors.hpp"

#include "common/fast_math.hpp"
#include "joint/edge_ratio.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// The measurements of the first frequency in successive pixels.
struct Pixels {
  int rows;
  const float* phase;
  const float* amplitude;
  const float* variance_m2;
  const float* outlier_share;
};

/// The measurements of another frequency in the same pixels.
struct OtherFrequency {
  const float* phase;
  const float* variance_m2;  ///< of its residual to the first frequency, without that one's noise
  double wavelength_ratio;   ///< of the first frequency to this one
  float wavelength_m;
};

/// Number of pixels whose unary factors are computed at a time.
constexpr int evidence_rows = 4 * DiagonalLayout::lanes;

/// One number for each pixel of a block.
using Block = std::array<float, evidence_rows>;

/// How sharply the residual of each pixel is distributed around its true value.
struct Sharpness {
  Block precision;  ///< 1 / variance of the residual, 1 / cycles²
  Block height;     ///< density of the residual at the true wrap count
};

/// Returns the smallest precision among the pixels whose residual is informative.
TOFMAP_VECTOR_CLONES float fill_sharpness(int rows, const float* variance_m2,
                                          const float* other_variance_m2, float wavelength_m,
                                          Sharpness& out) {
  const float squared_m2 = wavelength_m * wavelength_m;
  float* precision = out.precision.data();
  float* height = out.height.data();
  constexpr float least_telling = 1e-3F;  // a noise of thirty cycles
  std::array<float, DiagonalLayout::lanes> least;
  least.fill(largest_ratio);
  for (int i = 0; i < rows; i += DiagonalLayout::lanes) {
#pragma GCC ivdep
    for (int k = 0; k < DiagonalLayout::lanes; ++k) {
      const float variance = variance_m2[i + k] + other_variance_m2[i + k];
      const float sharp = squared_m2 / variance;
      precision[i + k] = sharp;
      height[i + k] = std::sqrt(sharp * (0.5F / std::numbers::pi_v<float>));
      const float counted = sharp > least_telling ? sharp : largest_ratio;
      float& lane = least[static_cast<std::size_t>(k)];
      lane = counted < lane ? counted : lane;
    }
  }
  return least_of(least);
}

/// The ranges of the pixels of a block for one wrap count, as the frequencies so far estimate them.
struct RangeEstimate {
  Block change_m;     ///< estimate minus the range of the first frequency
  Block variance_m2;  ///< of the estimate
  Block likelihood;   ///< of the wrap count by the frequencies so far
};

/// What one frequency contributes to the likelihoods of a block.
enum class Place {
  only,   ///< the camera has no further frequency
  first,  ///< the first one after that of the wrap counts
  inner,
  last,
};

/// Equation 11: multiplies the likelihoods of one wrap count by those of the residual of a
/// frequency, and refines the estimate of the range: the residual of the next frequency is one to
/// the mean of all frequencies so far, as far as their residuals come from a surface. `shift` is
/// the change of the residual by the wrap count, in cycles. `passes` states that the noise of the
/// residual may exceed half a cycle, so that the nearest other wrap matters, too.
template <Place place, bool passes>
[[gnu::always_inline]] inline void multiply_likelihood(const Pixels& pixels,
                                                       const OtherFrequency& other, float shift,
                                                       const Sharpness& sharpness,
                                                       RangeEstimate& estimate) {
  constexpr bool starts = place == Place::only || place == Place::first;
  constexpr bool refines = place == Place::first || place == Place::inner;
  const auto ratio = static_cast<float>(other.wavelength_ratio);
  const float wavelength_m = other.wavelength_m;
  float* change_m = estimate.change_m.data();
  float* variance_m2 = estimate.variance_m2.data();
  float* likelihood = estimate.likelihood.data();
#pragma GCC ivdep
  for (int i = 0; i < pixels.rows; ++i) {
    const float own_m2 = starts ? pixels.variance_m2[i] : variance_m2[i];
    float precision = sharpness.precision[static_cast<std::size_t>(i)];
    float height = sharpness.height[static_cast<std::size_t>(i)];
    float cycles = pixels.phase[i] * ratio + shift - other.phase[i];
    if constexpr (!starts) {
      cycles += change_m[i] / wavelength_m;
      precision = wavelength_m * wavelength_m / (own_m2 + other.variance_m2[i]);
      height = std::sqrt(precision * (0.5F / std::numbers::pi_v<float>));
    }
    const float offset = to_half_cycle(cycles);
    const float size = offset < 0 ? -offset : offset;
    // Density of the residual, up to the factor `height`. An outlier has density 1 per cycle.
    float density = exp_of_negative(-0.5F * precision * size * size);
    if constexpr (passes) {
      const float rest = 1 - size;
      density += exp_of_negative(-0.5F * precision * rest * rest);
    }
    const float outlier = pixels.outlier_share[i];
    const float of_surface = (1 - outlier) * height * density;
    likelihood[i] = (starts ? 1.0F : likelihood[i]) * (outlier + of_surface);
    if constexpr (refines) {
      const float trust = of_surface / (outlier + of_surface);
      const float gain = trust * own_m2 / (own_m2 + other.variance_m2[i]);
      change_m[i] = (starts ? 0.0F : change_m[i]) - gain * offset * wavelength_m;
      variance_m2[i] = own_m2 * (1 - gain);
    }
  }
}

/// The likelihoods of one wrap count by all frequencies.
template <bool passes>
[[gnu::always_inline]] inline void find_likelihood(const Pixels& pixels,
                                                   std::span<const OtherFrequency> others,
                                                   int count,
                                                   const std::vector<Sharpness>& sharpness,
                                                   RangeEstimate& estimate) {
  for (std::size_t f = 0; f < others.size(); ++f) {
    // Cycles in `count` wavelengths of the first frequency, reduced to −1/2 … 1/2, so that wrap
    // counts which the frequencies cannot tell apart get the same unary factor to the last bit.
    const auto shift = static_cast<float>(residual_shift_cycles(others[f].wavelength_ratio, count));
    const auto multiply = [&]<Place place>() {
      multiply_likelihood<place, passes>(pixels, others[f], shift, sharpness[f], estimate);
    };
    const bool is_first = f == 0;
    const bool is_last = f + 1 == others.size();
    if (is_first && is_last) {
      multiply.template operator()<Place::only>();
    } else if (is_first) {
      multiply.template operator()<Place::first>();
    } else if (is_last) {
      multiply.template operator()<Place::last>();
    } else {
      multiply.template operator()<Place::inner>();
    }
  }
}

/// The unary factors of a block, `step` values from one wrap count to the next.
struct Evidence {
  BFloat16* data;
  std::size_t step;

  BFloat16* operator[](int count) const { return data + static_cast<std::size_t>(count) * step; }
};

/// The unary factors of the pixels of a block, from their residuals at all other frequencies.
template <bool passes>
[[gnu::always_inline]] inline void fill_evidence_of(const Pixels& pixels,
                                                    std::span<const OtherFrequency> others,
                                                    int counts, float farthest_cycles,
                                                    const std::vector<Sharpness>& sharpness,
                                                    const Evidence& evidence) {
  const int rows = pixels.rows;
  Block best{};
  RangeEstimate estimate;
  for (int k = 0; k < counts; ++k) {
    BFloat16* at = evidence[k];
    find_likelihood<passes>(pixels, others, k, sharpness, estimate);
    const float farthest = k == 0 ? 1 : farthest_cycles - static_cast<float>(k);
#pragma GCC ivdep
    for (int i = 0; i < rows; ++i) {
      const float within = pixels.phase[i] <= farthest ? 1.0F : 0.0F;
      const float value = within * estimate.likelihood[static_cast<std::size_t>(i)];
      at[i] = to_bfloat16(value);
      best[static_cast<std::size_t>(i)] =
          value > best[static_cast<std::size_t>(i)] ? value : best[static_cast<std::size_t>(i)];
    }
  }
  for (int i = 0; i < rows; ++i) {
    best[static_cast<std::size_t>(i)] = 1 / best[static_cast<std::size_t>(i)];
  }
  for (int k = 0; k < counts; ++k) {
    BFloat16* at = evidence[k];
#pragma GCC ivdep
    for (int i = 0; i < rows; ++i) {
      const float share = to_float(at[i]) * best[static_cast<std::size_t>(i)];
      const float squared = share * share;
      const float tempered = squared * squared;
      static_assert(evidence_exponent == 4);
      at[i] = to_bfloat16(tempered > least_unary_factor ? tempered : least_unary_factor);
    }
  }
}

TOFMAP_VECTOR_CLONES void fill_evidence(const Pixels& pixels,
                                        const std::vector<OtherFrequency>& others, int counts,
                                        float farthest_cycles,
                                        const std::vector<Sharpness>& sharpness,
                                        const Evidence& evidence) {
  fill_evidence_of<true>(Pixels(pixels), others, counts, farthest_cycles, sharpness,
                         Evidence(evidence));
}

TOFMAP_VECTOR_CLONES void fill_sharp_evidence(const Pixels& pixels,
                                              const std::vector<OtherFrequency>& others, int counts,
                                              float farthest_cycles,
                                              const std::vector<Sharpness>& sharpness,
                                              const Evidence& evidence) {
  fill_evidence_of<false>(Pixels(pixels), others, counts, farthest_cycles, sharpness,
                          Evidence(evidence));
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

/// mixed_pixels() for pixels of one row.
TOFMAP_VECTOR_CLONES void find_mixed(int count, const Cross& cross_, const float* sigma_cycles,
                                     std::uint8_t* mixed) {
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
    mixed[i] = (across > along ? across : along) > step ? 1 : 0;
  }
}

/// Equations 12 to 14: the pairwise factors between pixels and their neighbours.
TOFMAP_VECTOR_CLONES void fill_edges(const Pixels& from, const Pixels& to, const EdgeScale& scale_,
                                     float* same, float* next) {
  const EdgeScale scale = scale_;
  const float* phase_from = from.phase;
  const float* phase_to = to.phase;
  const float* variance_from = from.variance_m2;
  const float* variance_to = to.variance_m2;
  const float* amplitude_from = from.amplitude;
  const float* amplitude_to = to.amplitude;
#pragma GCC ivdep
  for (int i = 0; i < from.rows; ++i) {
    const float difference = phase_to[i] - phase_from[i];
    const float toward = difference > 0 ? -1.0F : 1.0F;
    const EdgeRatio surface(scale, variance_from[i] + variance_to[i], amplitude_from[i],
                            amplitude_to[i]);
    const auto ratio = [&](float cycles) {
      const float r = surface(cycles);
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

Pixels pixels_at(const PixelArrays& pixels, std::size_t at, int count) {
  return {count, &pixels.phases[0][at], &pixels.amplitude[at], &pixels.variances_m2[0][at],
          &pixels.outlier_share[at]};
}

}  // namespace

void PixelArrays::assign(std::size_t pixels, std::size_t frequencies, float outlier) {
  phases.resize(frequencies);
  variances_m2.resize(frequencies);
  for (std::vector<float>& plane : phases) plane.assign(pixels, 0.0F);
  for (std::vector<float>& plane : variances_m2) plane.assign(pixels, 4 * largest_ratio);
  amplitude.assign(pixels, 1.0F);
  outlier_share.assign(pixels, outlier);
}

UnaryFactors::UnaryFactors(const UnwrapLimits& limits)
    : limits_(limits),
      others_(others_by_wavelength(limits.wavelengths_m)),
      farthest_cycles_(static_cast<float>(limits.max_range_m / limits.wavelength_m() +
                                          noise_tolerance_cycles)) {}

void UnaryFactors::fill(const PixelArrays& pixels, std::size_t at, int count,
                        std::uint16_t* factors, std::size_t step) const {
  std::vector<OtherFrequency> others(others_.size());
  std::vector<Sharpness> sharpness(others_.size());
  for (int done = 0; done < count; done += evidence_rows) {
    const int rows = std::min(evidence_rows, count - done);
    const std::size_t first = at + static_cast<std::size_t>(done);
    // Above this precision, half a cycle is more than seven standard deviations, and the nearest
    // other wrap has a density that is lost in rounding.
    constexpr float sharp = 200;
    bool is_sharp = true;
    for (std::size_t i = 0; i < others_.size(); ++i) {
      const std::size_t f = others_[i];
      const double wavelength_m = limits_.wavelengths_m[f];
      others[i] = {&pixels.phases[f][first], &pixels.variances_m2[f][first],
                   limits_.wavelength_m() / wavelength_m, static_cast<float>(wavelength_m)};
      const float least =
          fill_sharpness(rows, &pixels.variances_m2[0][first], others[i].variance_m2,
                         others[i].wavelength_m, sharpness[i]);
      is_sharp = is_sharp && least > sharp;
    }
    (is_sharp ? fill_sharp_evidence : fill_evidence)(pixels_at(pixels, first, rows), others,
                                                     limits_.count, farthest_cycles_, sharpness,
                                                     Evidence{factors + done, step});
  }
}

EdgeScale::EdgeScale(const UnwrapLimits& limits, const WrapCountPrior& prior)
    : wavelength_m(static_cast<float>(limits.wavelength_m())),
      slope_m2(static_cast<float>(prior.slope_m * prior.slope_m)),
      edge_share(static_cast<float>(prior.edge_share)),
      edge_density(static_cast<float>(1 / (2 * prior.edge_reach_m))),
      amplitude_weight(prior.amplitude_edges ? 1.0F : 0.0F) {}

void fill_pairwise_factors(const PixelsAt& from, const PixelsAt& to, int count,
                           const EdgeScale& scale, float* same, float* next) {
  fill_edges(pixels_at(from.pixels, from.at, count), pixels_at(to.pixels, to.at, count), scale,
             same, next);
}

ImageU8 mixed_pixels(const ImageF& amplitude, const ImageF& sigma_cycles) {
  const auto rows = static_cast<int>(amplitude.rows());
  const auto cols = static_cast<int>(amplitude.cols());
  ImageU8 mixed = ImageU8::Zero(rows, cols);
  for (int v = 1; v + 1 < rows; ++v) {
    const float* here = amplitude.data() + v * cols + 1;
    find_mixed(cols - 2, {here, here - 1, here + 1, here - cols, here + cols},
               sigma_cycles.data() + v * cols + 1, mixed.data() + v * cols + 1);
  }
  return mixed;
}

}  // namespace tofmap
