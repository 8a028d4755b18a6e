// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/libfreenect2_unwrap.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap::peers {
namespace {

// Cycles of each frequency in units of 1/30 of the non-ambiguity range.
constexpr float cycle_80 = 3;
constexpr float cycle_16 = 15;
constexpr float cycle_120 = 2;

void check(const ThreePhases& phases) {
  const auto& f = phases.frequencies_hz;
  const double unit_hz = f[1] / 2;
  if (std::abs(f[0] - 10 * unit_hz) > 1e-3 * f[0] || std::abs(f[2] - 15 * unit_hz) > 1e-3 * f[2])
    throw UsageError(fmt::format(
        "frequencies_hz: {} Hz, {} Hz and {} Hz, but libfreenect2 unwraps 80, 16 and 120 MHz", f[0],
        f[1], f[2]));
}

/// The limits of a pixel on its own.
struct Limits {
  float metres_per_cycle;  ///< of the mean frequency
  bool reject;
  float min_amplitude;
  float min_amplitude_sum;
  float log_scale;
  float exponent;
  float log_min;
  float log_max;
  float min_range_m;
  float max_range_m;
};

Limits limits_of(const ThreePhases& phases, const Libfreenect2Options& options) {
  const auto& f = phases.frequencies_hz;
  const double sum_hz = f[0] + f[1] + f[2];
  const auto number = [](double x) { return static_cast<float>(x); };
  return {.metres_per_cycle = number(options.camera.speed_of_light_m_s / 2 * 3 / sum_hz),
          .reject = options.reject_outliers,
          .min_amplitude = number(options.min_amplitude),
          .min_amplitude_sum = number(options.min_amplitude_sum),
          .log_scale = number(std::log(options.agreement_scale_rad)),
          .exponent = number(options.agreement_exponent),
          .log_min = number(std::log(options.min_agreement_rad)),
          .log_max = number(std::log(options.max_agreement_rad)),
          .min_range_m = number(options.min_range_m),
          .max_range_m = number(options.max_range_m)};
}

[[gnu::always_inline]] inline float nearest_whole(float x) { return std::floor(x + 0.5F); }

/// Phases of the three frequencies with their wrap counts added.
struct Unwrapped {
  float cycles_80;
  float cycles_16;
  float cycles_120;
  float count_80;
};

[[gnu::always_inline]] inline Unwrapped unwrap_pixel(float phase_80, float phase_16,
                                                     float phase_120) {
  const float t_80 = cycle_80 * phase_80;
  const float t_16 = cycle_16 * phase_16;
  const float t_120 = cycle_120 * phase_120;
  const float count_in_16 = nearest_whole((t_16 - t_80) / cycle_80);
  const float within_16 = t_80 + cycle_80 * count_in_16;
  const float pairs = std::fabs(within_16 - t_120) / 2;
  const float odd = 2 * (pairs - std::floor(pairs));
  const float wraps_16 = odd > 0.5F && odd < 1.5F ? 1.0F : 0.0F;
  const float whole = within_16 + cycle_16 * wraps_16;
  const float count_120 = nearest_whole((whole - t_120) / cycle_120);
  return {.cycles_80 = whole / cycle_80,
          .cycles_16 = phase_16 + wraps_16,
          .cycles_120 = phase_120 + count_120,
          .count_80 = count_in_16 + wraps_16 * (cycle_16 / cycle_80)};
}

/// The squared distance of the unwrapped phases from the line of equal ranges, in rad².
[[gnu::always_inline]] inline float squared_disagreement(const Unwrapped& p) {
  // The line's direction is (10, 2, 15) / √329.
  constexpr float x = 0.551318F;
  constexpr float y = 0.110264F;
  constexpr float z = 0.826977F;
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  const float a = p.cycles_16 * z - p.cycles_120 * y;
  const float b = p.cycles_120 * x - p.cycles_80 * z;
  const float c = p.cycles_80 * y - p.cycles_16 * x;
  return turn * turn * (a * a + b * b + c * c);
}

struct Measurements {
  const float* phase_80;
  const float* phase_16;
  const float* phase_120;
  const float* amplitude_80;
  const float* amplitude_16;
  const float* amplitude_120;
};

struct Outputs {
  float* range_m;
  std::int32_t* rejection;
  std::int32_t* wrap_count;
};

[[gnu::always_inline]] inline float smaller(float a, float b) { return a < b ? a : b; }
[[gnu::always_inline]] inline float larger(float a, float b) { return a > b ? a : b; }
[[gnu::always_inline]] inline std::int32_t code(Rejection rejection) {
  return static_cast<std::int32_t>(rejection);
}

TOFMAP_VECTOR_CLONES void unwrap_pixels(Eigen::Index count, const Limits& given,
                                        const Measurements& in, const Outputs& out) {
  const Limits limits = given;
  // Without rejection, nothing is beyond these limits.
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const float disagreement_factor = limits.reject ? 1.0F : 0.0F;
  const float min_amplitude = limits.reject ? limits.min_amplitude : -infinity;
  const float min_amplitude_sum = limits.reject ? limits.min_amplitude_sum : -infinity;
  constexpr float ln_2 = std::numbers::ln2_v<float>;
#pragma GCC ivdep
  for (Eigen::Index i = 0; i < count; ++i) {
    const float a = in.amplitude_80[i];
    const float b = in.amplitude_16[i];
    const float c = in.amplitude_120[i];
    const float sum = a + b + c;
    const Unwrapped p = unwrap_pixel(in.phase_80[i], in.phase_16[i], in.phase_120[i]);
    const float range_m =
        (p.cycles_80 + p.cycles_16 + p.cycles_120) * (limits.metres_per_cycle / 3);

    const float largest = larger(larger(larger(a, b), c), 1e-6F);
    const float log_limit = limits.log_scale + limits.exponent * ln_2 * log2_of(largest);
    const float clamped = smaller(larger(log_limit, limits.log_min), limits.log_max);
    const float limit_rad2 = exp_of_negative(2 * clamped);

    // The later one of two reasons is told.
    std::int32_t rejection = range_m > 0 ? code(Rejection::none) : code(Rejection::out_of_range);
    rejection = range_m >= limits.min_range_m ? rejection : code(Rejection::out_of_range);
    rejection = range_m <= limits.max_range_m ? rejection : code(Rejection::out_of_range);
    const float disagreement_rad2 = disagreement_factor * squared_disagreement(p);
    rejection = disagreement_rad2 > limit_rad2 ? code(Rejection::inconsistent) : rejection;
    rejection = smaller(smaller(a, b), c) < min_amplitude ? code(Rejection::weak) : rejection;
    rejection = sum < min_amplitude_sum ? code(Rejection::weak) : rejection;
    rejection = range_m == range_m ? rejection : code(Rejection::no_return);
    rejection = sum > 0 ? rejection : code(Rejection::no_return);
    out.rejection[i] = rejection;
    out.range_m[i] = rejection == 0 ? range_m : nan;
    const float counted = p.count_80 >= 0 ? p.count_80 : 255.0F;  // not if NaN
    out.wrap_count[i] = static_cast<std::int32_t>(counted);
  }
}

/// Whether the edge filter rejects a pixel that is not in the outermost rows or columns.
bool at_edge(const ImageF& range_m, const ImageU8& on_edge, const ImageF& amplitude_sum,
             Eigen::Index v, Eigen::Index u, const Libfreenect2Options& options) {
  if (on_edge(v, u) != 0) return true;
  double sum = 0;
  double sum_of_squares = 0;
  const float own_m = range_m(v, u);
  float nearest_m = own_m;
  float farthest_m = own_m;
  for (Eigen::Index dv = -1; dv <= 1; ++dv) {
    for (Eigen::Index du = -1; du <= 1; ++du) {
      const double amplitude = amplitude_sum(v + dv, u + du);
      sum += amplitude;
      sum_of_squares += amplitude * amplitude;
      const float other_m = range_m(v + dv, u + du);
      if (std::isnan(other_m) || on_edge(v + dv, u + du) != 0) continue;
      nearest_m = std::min(nearest_m, other_m);
      farthest_m = std::max(farthest_m, other_m);
    }
  }
  const double deviation = std::sqrt(std::max(0.0, 9 * sum_of_squares - sum * sum)) / 9;
  const double behind_m = own_m - nearest_m;
  const double before_m = farthest_m - own_m;
  return deviation >=
             options.edge_amplitude_deviation * std::max(sum / 9, options.edge_amplitude_floor) &&
         behind_m > options.edge_behind_nearest_m && before_m > options.edge_before_farthest_m &&
         std::max(behind_m, before_m) > options.edge_either_m;
}

void reject_edges(const ThreePhases& phases, const ImageU8& on_edge,
                  const Libfreenect2Options& options, Libfreenect2Result& result) {
  const ImageF unfiltered_m = result.range_m;
  const ImageF sum = phases.amplitude[0] + phases.amplitude[1] + phases.amplitude[2];
  const ImageF amplitude_sum = sum.isNaN().select(ImageF::Zero(sum.rows(), sum.cols()), sum);
  for (Eigen::Index v = 1; v < sum.rows() - 1; ++v) {
    for (Eigen::Index u = 1; u < sum.cols() - 1; ++u) {
      if (std::isnan(unfiltered_m(v, u))) continue;
      if (!at_edge(unfiltered_m, on_edge, amplitude_sum, v, u, options)) continue;
      result.range_m(v, u) = nan;
      result.rejection(v, u) = static_cast<std::uint8_t>(Rejection::edge);
    }
  }
}

}  // namespace

Libfreenect2Result libfreenect2_unwrap(const ThreePhases& measured,
                                       const Libfreenect2Options& options) {
  check(measured);
  SmoothedPhases input{calibrated(measured, options.camera), {}};
  if (options.smooth) {
    input = smooth_phases(input.phases, options.smoothing);
  } else {
    input.on_edge.setZero(measured.rows(), measured.cols());
  }
  const ThreePhases& phases = input.phases;

  Libfreenect2Result result;
  result.range_m.resize(phases.rows(), phases.cols());
  Image<std::int32_t> rejection(phases.rows(), phases.cols());
  Image<std::int32_t> wrap_count(phases.rows(), phases.cols());
  unwrap_pixels(
      phases.phase_cycles[0].size(), limits_of(phases, options),
      {phases.phase_cycles[0].data(), phases.phase_cycles[1].data(), phases.phase_cycles[2].data(),
       phases.amplitude[0].data(), phases.amplitude[1].data(), phases.amplitude[2].data()},
      {result.range_m.data(), rejection.data(), wrap_count.data()});
  result.rejection = rejection.cast<std::uint8_t>();
  result.wrap_count = wrap_count.cast<std::uint8_t>();
  if (options.reject_outliers && options.edge_filter)
    reject_edges(phases, input.on_edge, options, result);
  return result;
}

}  // namespace tofmap::peers
