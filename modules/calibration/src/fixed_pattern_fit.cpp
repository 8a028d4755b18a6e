// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/calibration/fixed_pattern_fit.hpp"

#include "offset_shrinkage.hpp"
#include "pixel_errors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Errors further from the mean of their pixel than this number of standard deviations are
/// outliers.
constexpr double outlier_sigmas = 3;

/// The average of the errors of one frequency, and what the next one needs to know of it.
struct Average {
  std::vector<PixelSums> pixels;
  SampleNoise noise;
};

/// One frequency of one frame.
struct PhaseView {
  const ImageF& phase;
  const ImageF* amplitude;  ///< null without amplitudes
  double wavelength_m;
  double saturation_amplitude;  ///< 0: no pixel is saturated
};

PhaseView phase_view(const Frame& frame, const SensorModel& sensor, std::size_t frequency) {
  return {frame.phases[frequency], frame.has_amplitude() ? &frame.amplitudes[frequency] : nullptr,
          sensor.modulation.wavelength_m(frequency), sensor.saturation_amplitude};
}

/// The error of a pixel against its reference range, with the wrap count that brings it nearest;
/// the weight is that of its noise alone. Empty if it is not known.
std::optional<PixelError> error_in(const PhaseView& view, float reference_m, Eigen::Index pixel) {
  const float phase = view.phase.data()[pixel];
  if (std::isnan(phase) || std::isnan(reference_m)) return std::nullopt;
  PixelError error;
  if (view.amplitude != nullptr) {
    const double amplitude = view.amplitude->data()[pixel];
    if (view.saturation_amplitude > 0 && amplitude >= view.saturation_amplitude) {
      return std::nullopt;
    }
    error.relative_noise = view.wavelength_m / std::max(1.0, amplitude);
  }
  error.weight = 1 / (error.relative_noise * error.relative_noise);
  const double off_cycles = phase - reference_m / view.wavelength_m;
  error.error_m = view.wavelength_m * (off_cycles - std::round(off_cycles));
  return error;
}

/// The error with its weight, given the average so far. Empty if it is an outlier.
std::optional<PixelError> weighted_error(PixelError error, const Average& before,
                                         std::size_t pixel) {
  const PixelSums& known = before.pixels[pixel];
  if (known.count == 0) return std::nullopt;
  error.weight = before.noise.weight(error.relative_noise);
  const double limit_m = outlier_sigmas / std::sqrt(error.weight);
  if (std::abs(error.error_m - known.mean_m()) > limit_m) return std::nullopt;
  return error;
}

/// The change of a pixel's range, 0 if it is unknown. A change beyond `most_m` is an edge that
/// passes the pixel, so it says nothing about the time between the exposures.
double known_change_m(const ImageF& change_m, Eigen::Index pixel, double most_m) {
  if (change_m.size() == 0) return 0;
  const double known_m = change_m.data()[pixel];
  return std::abs(known_m) <= most_m ? known_m : 0;
}

/// Adds the errors of one frame. `before` is the average so far, or null.
void add_errors(const PhaseView& view, const ReferencedFrame& from, double max_error_m,
                const Average* before, std::vector<PixelSums>& pixels) {
  if (!same_size(from.reference_m, view.phase)) {
    throw UsageError("fit_fixed_pattern: frame and reference ranges differ in size");
  }
  pixels.resize(static_cast<std::size_t>(view.phase.size()));
  for (Eigen::Index i = 0; i < view.phase.size(); ++i) {
    const auto pixel = static_cast<std::size_t>(i);
    const float range_m = from.reference_m.data()[i];
    std::optional<PixelError> error = error_in(view, range_m, i);
    if (!error) continue;
    if (before != nullptr) {
      error = weighted_error(*error, *before, pixel);
    } else if (std::abs(error->error_m) > max_error_m) {
      continue;
    }
    if (!error) continue;
    error->change_m = known_change_m(from.change_m, i, max_error_m);
    pixels[pixel].add(*error, pixel);
    const double rad = 2 * std::numbers::pi * 4 * range_m / view.wavelength_m;
    pixels[pixel].fourth_harmonic += std::polar(error->weight, rad);
  }
}

/// The averages of all frequencies. `before` is empty or has one for each frequency.
std::vector<Average> average(const ReferencedFrames& frames, const SensorModel& sensor,
                             double max_error_m, const std::vector<Average>& before) {
  std::vector<Average> averages(sensor.modulation.count());
  frames([&](const ReferencedFrame& one) {
    for (std::size_t f = 0; f < averages.size(); ++f) {
      add_errors(phase_view(one.frame, sensor, f), one, max_error_m,
                 before.empty() ? nullptr : &before[f], averages[f].pixels);
    }
  });
  for (Average& one : averages) one.noise = noise_of(one.pixels);
  return averages;
}

/// The variance of an error with weight 1, from the scatter of all pixels over the frames. NaN if
/// no pixel has two errors.
double unit_variance_m2(const std::vector<PixelSums>& pixels, double delay_frames) {
  double scatter_m2 = 0;
  double freedom = 0;
  for (const PixelSums& pixel : pixels) {
    if (pixel.count < 2) continue;
    scatter_m2 += pixel.scatter_m2(delay_frames);
    freedom += pixel.count - 1;
  }
  return freedom > 0 ? scatter_m2 / freedom : NAN;
}

/// The mean error of a pixel. Its variance is that of all pixels, or that of its own scatter if
/// this is larger: the scatter of few errors is often too small by chance.
MeasuredOffset measured_offset(const PixelSums& pixel, double unit_m2, double delay_frames) {
  double variance_m2 = unit_m2;
  if (pixel.count > 1)
    variance_m2 = std::max(unit_m2, pixel.scatter_m2(delay_frames) / (pixel.count - 1));
  return {pixel.mean_m(delay_frames), variance_m2 / pixel.weight};
}

/// The median of the numbers; NaN if there are none.
double median_or_nan(std::vector<double> numbers) {
  return numbers.empty() ? NAN : median(numbers);
}

double median_periodic_share(const std::vector<PixelSums>& pixels) {
  std::vector<double> shares;
  for (const PixelSums& pixel : pixels) {
    if (pixel.count > 0) shares.push_back(std::abs(pixel.fourth_harmonic) / pixel.weight);
  }
  return median_or_nan(std::move(shares));
}

PatternEstimate estimate_of(const std::vector<PixelSums>& pixels, const CameraModel& camera) {
  PatternEstimate estimate{.error_m = ImageF::Constant(camera.height_px, camera.width_px, nan)};
  estimate.delay_frames = delay_of(pixels);
  const double unit_m2 = unit_variance_m2(pixels, estimate.delay_frames);
  std::vector<MeasuredOffset> offsets;
  std::vector<double> noises_m;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].count == 0) continue;
    estimate.error_m.data()[i] = 0;
    offsets.push_back(measured_offset(pixels[i], unit_m2, estimate.delay_frames));
    noises_m.push_back(std::sqrt(offsets.back().variance));
  }
  estimate.pixels = offsets.size();
  estimate.periodic_share = median_periodic_share(pixels);
  estimate.noise_m = std::isnan(unit_m2) ? NAN : median_or_nan(std::move(noises_m));
  if (!(unit_m2 > 0)) return estimate;
  const OffsetDistribution distribution = distribution_of(offsets);
  if (distribution.variance == 0) return estimate;
  estimate.sigma_m = std::sqrt(distribution.variance);
  double remaining_m2 = 0;
  std::size_t next = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (pixels[i].count == 0) continue;
    const MeasuredOffset& offset = offsets[next++];
    const double error_m = distribution.shrunk(offset);
    const bool is_possible = std::abs(error_m) <= largest_pattern_error_m;
    estimate.error_m.data()[i] = is_possible ? static_cast<float>(error_m) : nan;
    remaining_m2 += distribution.remaining_variance(offset);
  }
  estimate.remaining_m = std::sqrt(remaining_m2 / static_cast<double>(offsets.size()));
  return estimate;
}

}  // namespace

std::vector<PatternEstimate> fit_fixed_pattern(const ReferencedFrames& frames,
                                               const SensorModel& sensor, double max_error_m) {
  std::vector<Average> averages;
  for (int i = 0; i < pattern_averagings; ++i)
    averages = average(frames, sensor, max_error_m, averages);
  std::vector<PatternEstimate> estimates;
  for (const Average& one : averages) estimates.push_back(estimate_of(one.pixels, sensor.camera));
  return estimates;
}

}  // namespace tofmap
