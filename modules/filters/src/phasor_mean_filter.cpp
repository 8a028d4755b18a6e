// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/phasor_mean_filter.hpp"

#include "phasor_windows.hpp"
#include "size_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <vector>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// Standard deviation of a phase that the largest windows are to reach. At 40 MHz it is 6 cm of
/// range from one frequency, and 4 cm from two.
constexpr double enough_sigma_rad = 0.1;

/// Factor by which the standard deviation of a mean over a window that selects agreeing pixels
/// exceeds that over a fixed window. Chosen on random rooms of the seeds 11 to 18.
constexpr double selection = 1.4;

/// Probability that a window contains several surfaces, so that its wrap count means nothing.
/// Chosen on random rooms of the seeds 21 to 32.
constexpr double mixed_share = 0.005;

/// The phase noise of valid pixels in cycles; NaN for invalid pixels. Where it is so large, ranges
/// are not fused, but those of the frequency that was counted.
ImageF noise_cycles(const RangeImage& image, const Modulation& modulation) {
  const std::size_t counted = counted_frequency(wavelengths_m(modulation));
  return image.sigma_m / static_cast<float>(modulation.wavelength_m(counted));
}

/// The radius at which a window without edges reaches `enough_sigma_rad`, for the median noise of
/// the noisy pixels. A window of radius h with the weights 1 − r² / h² averages noise as much as
/// ¾ π h² equal pixels do.
double wanted_radius_px(const ImageF& noise, float least_noise) {
  std::vector<float> noisy;
  for (const float cycles : noise.reshaped()) {
    if (cycles > least_noise) noisy.push_back(cycles);
  }
  const double information = phase_information(median(noisy));
  return std::sqrt(1 /
                   (enough_sigma_rad * enough_sigma_rad * 0.75 * std::numbers::pi * information));
}

/// The phase at a pixel, 0 … 1 cycles.
double cycles_of(const PhasorImage& phasors, int v, int u) {
  const double cycles = std::atan2(phasors.im.row(v)[u], phasors.re.row(v)[u]) / two_pi;
  return cycles - std::floor(cycles);
}

/// What one frequency says of a pixel.
struct WrappedRange {
  double range_m;  ///< modulo the wavelength
  double wavelength_m;
  double variance_m2;
};

/// The wrapped ranges of all frequencies at a pixel, from its plane.
struct WrappedRanges {
  std::vector<WrappedRange> frequencies;  ///< A, whose wrap counts are tried, first
  double common_variance_m2 = 0;          ///< of the error that all have in common

  /// Reads the pixel (v, u) of the planes. Its memory is used again.
  void read(const PhasePlanes& planes, int v, int u, const Modulation& modulation,
            const std::vector<std::size_t>& order) {
    constexpr double least_coherence = 0.05;
    // If the phasors of the window cancel more than predicted, noise is larger by that factor.
    const double coherence = std::max<double>(least_coherence, planes.coherence.row(v)[u]);
    const double scale = selection / (coherence * two_pi);
    const double cycles2 = scale * scale * planes.variance.row(v)[u];
    frequencies.clear();
    for (const std::size_t f : order) {
      const double wavelength_m = modulation.wavelength_m(f);
      frequencies.push_back({cycles_of(planes.phases[f], v, u) * wavelength_m, wavelength_m,
                             cycles2 * wavelength_m * wavelength_m});
    }
    const double a_m = modulation.wavelength_m(0);
    common_variance_m2 = scale * scale * planes.lever_variance.row(v)[u] * a_m * a_m;
  }
};

/// A range from all frequencies for one wrap count.
struct CountedRange {
  double range_m = 0;
  double variance_m2 = 0;
  double probability = 0;
};

/// The range for the wrap count n of A, with its likelihood in place of its probability
/// (docs/filters.md, equation 14).
CountedRange counted_range(const std::vector<WrappedRange>& frequencies, int n) {
  const WrappedRange& a = frequencies.front();
  CountedRange out{a.range_m + n * a.wavelength_m, a.variance_m2, 1};
  for (std::size_t i = 1; i < frequencies.size(); ++i) {
    const WrappedRange& other = frequencies[i];
    const double variance_m2 = out.variance_m2 + other.variance_m2;
    const double residual_m = std::remainder(out.range_m - other.range_m, other.wavelength_m);
    out.probability *= std::exp(-0.5 * residual_m * residual_m / variance_m2);
    out.range_m -= residual_m * out.variance_m2 / variance_m2;
    out.variance_m2 *= other.variance_m2 / variance_m2;
  }
  return out;
}

/// The most probable range among the wrap counts 0 … `counts` − 1 of A (docs/filters.md, equation
/// 14). range_m is 0 if no count is possible.
CountedRange likeliest_range(const std::vector<WrappedRange>& frequencies, int counts,
                             double own_range_m, double own_confidence) {
  const double own = std::clamp(own_confidence, 0.01, 0.99);
  CountedRange best;
  double sum = 0;
  for (int n = 0; n < counts; ++n) {
    CountedRange counted = counted_range(frequencies, n);
    if (counted.range_m <= 0) continue;
    const bool is_own =
        std::abs(counted.range_m - own_range_m) < frequencies.front().wavelength_m / 2;
    counted.probability *= is_own ? own : (1 - own) / std::max(1, counts - 1);
    sum += counted.probability;
    if (counted.probability > best.probability) best = counted;
  }
  best.probability *= (1 - mixed_share) / (sum > 0 ? sum : 1);
  return best;
}

/// 1 + the largest wrap count of a valid pixel.
int count_limit(const RangeImage& image) {
  return 1 + (image.reason == 0).select(image.wrap_count, std::uint8_t{0}).maxCoeff();
}

}  // namespace

RangeImage average_phasors(const RangeImage& image, const Frame& frame,
                           const Modulation& modulation, const PixelRays& rays,
                           const PhasorMeanLimits& limits) {
  // The few noisy pixels of a quiet frame are dark, far away, or seen at a grazing angle. Averaging
  // them over windows makes their ranges worse.
  constexpr double least_share = 0.5;
  check_size(image, rays, "phasor_mean filter");
  const auto least_noise = static_cast<float>(limits.min_noise_cycles);
  const ImageF noise = noise_cycles(image, modulation);
  const auto noisy = static_cast<double>((noise > least_noise).count());
  if (noisy == 0 || noisy < least_share * image.count_valid()) return image;
  if (frame.frequencies() == 1) return image;
  const auto fits = [&](const ImageF& phase) { return same_size(image.range_m, phase); };
  if (frame.phases.size() != modulation.count() || !std::ranges::all_of(frame.phases, fits)) {
    throw UsageError("phasor_mean filter: range image and frame differ in size or frequencies");
  }
  const double radius_px = std::min(limits.max_radius_px, wanted_radius_px(noise, least_noise));
  if (radius_px < 2) return image;
  WindowGrowth growth;
  growth.last_radius_px = radius_px;
  for (std::size_t f = 0; f < modulation.count(); ++f) {
    growth.wavelength_ratios.push_back(
        static_cast<float>(modulation.wavelength_m(0) / modulation.wavelength_m(f)));
  }
  const Phasors phasors(frame.phases, noise, static_cast<int>(std::ceil(radius_px)));
  const PhasePlanes planes = grow_phase_planes(phasors, static_cast<int>(image.rows()),
                                               static_cast<int>(image.cols()), growth);
  const int counts = count_limit(image);
  std::vector<std::size_t> order{0};
  std::ranges::copy(others_by_wavelength(wavelengths_m(modulation)), std::back_inserter(order));
  WrappedRanges wrapped;
  RangeImage out = image;
  out.averaged_px = ImageF::Ones(image.rows(), image.cols());
  for (int v = 0; v < image.rows(); ++v) {
    for (int u = 0; u < image.cols(); ++u) {
      if (!(noise(v, u) > least_noise)) continue;
      wrapped.read(planes, v, u, modulation, order);
      const CountedRange best =
          likeliest_range(wrapped.frequencies, counts, image.range_m(v, u), image.confidence(v, u));
      if (!(best.range_m > 0)) continue;
      out.range_m(v, u) = static_cast<float>(best.range_m);
      out.sigma_m(v, u) =
          static_cast<float>(std::sqrt(best.variance_m2 + wrapped.common_variance_m2));
      out.wrap_count(v, u) = static_cast<std::uint8_t>(best.range_m / modulation.wavelength_m(0));
      out.confidence(v, u) = static_cast<float>(best.probability);
      out.averaged_px(v, u) =
          std::max(1.0F, 1 / (phase_information(noise(v, u)) * planes.variance.row(v)[u]));
    }
  }
  return out;
}

}  // namespace tofmap
