// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "systematic_errors.hpp"

#include "noise.hpp"
#include "pixel_signal.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// The error that depends on amplitude is zero at this amplitude (a white wall at 0.3 m), and
/// reaches its full size this many decades below it.
constexpr double bright_end = 60000;
constexpr double decades = 3;

/// Sizes of the errors at one frequency, from the options.
struct ErrorSizes {
  double offset_m = 0;
  double periodic_m = 0;
  double amplitude_error_m = 0;
};

/// Two harmonics of the phase whose sum has the peak `peak_m` (docs/simulator.md, equation 10). The
/// key determines the share of each, at least 20 %, and their phases.
std::vector<WiggleHarmonic> drawn_harmonics(double peak_m, std::uint64_t key) {
  if (peak_m == 0) return {};
  const double share = 0.2 + 0.6 * share_of(key);
  const double second = rad_per_cycle * share_of(key + 1);
  const double fourth = rad_per_cycle * share_of(key + 2);
  PhaseError shape{
      .harmonics = {{2, share * std::sin(second), share * std::cos(second)},
                    {4, (1 - share) * std::sin(fourth), (1 - share) * std::cos(fourth)}}};
  // The sum repeats after half a cycle. This number of steps finds its peak to 1 part in 10^5.
  constexpr int steps = 1024;
  double peak = 0;
  for (int i = 0; i < steps; ++i) peak = std::max(peak, std::abs(shape.at_m(0.5 * i / steps)));
  for (WiggleHarmonic& harmonic : shape.harmonics) {
    harmonic.cosine_m *= peak_m / peak;
    harmonic.sine_m *= peak_m / peak;
  }
  return shape.harmonics;
}

RangeErrors drawn_errors(const SimulatorOptions& options, const ErrorSizes& sizes,
                         double wavelength_m, std::uint64_t key) {
  return {.wavelength_m = wavelength_m,
          .of_phase = {.offset_m = sizes.offset_m,
                       .harmonics = drawn_harmonics(sizes.periodic_m, mix(key))},
          .dark_end_m = sizes.amplitude_error_m,
          .pattern_sigma_m = options.fixed_pattern_m,
          .pattern_key = mix(key + 1)};
}

/// The key of the errors of one image. It differs from all keys of noise, even for the same seed:
/// those count upwards from the mixed seed, this one downwards.
std::uint64_t camera_key(const SimulatorOptions& options, std::uint64_t image) {
  return mix(mix(static_cast<std::uint64_t>(options.errors_seed)) - 1 - image);
}

}  // namespace

bool RangeErrors::are_none() const {
  return of_phase.offset_m == 0 && of_phase.harmonics.empty() && dark_end_m == 0 &&
         pattern_sigma_m == 0;
}

double RangeErrors::at_m(const std::complex<double>& signal, std::size_t pixel) const {
  double error_m = of_phase.at_m(std::arg(signal) / rad_per_cycle);
  if (dark_end_m != 0) {
    const double darker = std::log10(bright_end / std::max(std::abs(signal), 1.0)) / decades;
    error_m += dark_end_m * std::clamp(darker, 0.0, 1.0);
  }
  if (pattern_sigma_m != 0) error_m += pattern_sigma_m * complex_noise(pattern_key, pixel).real();
  return error_m;
}

std::complex<double> RangeErrors::rotation(const std::complex<double>& signal,
                                           std::size_t pixel) const {
  if (are_none()) return 1;
  return std::polar(1.0, rad_per_cycle * at_m(signal, pixel) / wavelength_m);
}

RangeErrors range_errors(const SimulatorOptions& options, const Modulation& modulation,
                         std::size_t frequency) {
  // The options of A and B, unless a list has the values of all frequencies.
  const auto value = [&](const std::vector<double>& listed, double of_a, double of_b) {
    if (!listed.empty()) return frequency < listed.size() ? listed[frequency] : 0;
    return frequency == 0 ? of_a : frequency == 1 ? of_b : 0;
  };
  const ErrorSizes sizes{
      value(options.offsets_m, options.offset_a_m, options.offset_b_m),
      value(options.periodic_errors_m, options.periodic_a_m, options.periodic_b_m),
      value(options.amplitude_errors_m, options.amplitude_error_a_m, options.amplitude_error_b_m)};
  return drawn_errors(options, sizes, modulation.wavelength_m(frequency),
                      camera_key(options, frequency));
}

double AmbientLight::noise_factor(Eigen::Index row, Eigen::Index col) const {
  const auto u = static_cast<double>(col);
  const auto v = static_cast<double>(row);
  const bool is_lit = u >= first_col && u < end_col && v >= first_row && v < end_row;
  return is_lit ? factor : 1;
}

AmbientLight ambient_light(const SimulatorOptions& options, const CameraModel& camera) {
  // The image reaches half a pixel beyond the centres of its outer pixels.
  return {.factor = options.ambient_noise,
          .first_col = options.ambient_left * camera.width_px - 0.5,
          .end_col = options.ambient_right * camera.width_px - 0.5,
          .first_row = options.ambient_top * camera.height_px - 0.5,
          .end_row = options.ambient_bottom * camera.height_px - 0.5};
}

float quantised(float phase_cycles, int bits) {
  if (bits == 0) return phase_cycles;
  const double levels = std::ldexp(1.0, bits);
  const double level = std::round(phase_cycles * levels);
  return level < levels ? static_cast<float>(level / levels) : 0.0F;
}

void check_systematic_errors(const SimulatorOptions& options) {
  if (options.phase_bits > 0 && options.phase_bits < 4) {
    throw UsageError("simulator.phase_bits must be 0 (not quantised) or 4 … 16, not " +
                     std::to_string(options.phase_bits));
  }
  const bool lights_something =
      options.ambient_left < options.ambient_right && options.ambient_top < options.ambient_bottom;
  if (options.ambient_noise > 1 && !lights_something) {
    throw UsageError(
        "simulator.ambient_left must be less than ambient_right, and ambient_top less than "
        "ambient_bottom: ambient light would fall on no pixel");
  }
}

}  // namespace tofmap
