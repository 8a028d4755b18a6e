// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/phases.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <tofmap/acquisition/kinect2/companding.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr double rad_per_cycle = 2 * std::numbers::pi;
constexpr double sin_120_deg = std::numbers::sqrt3 / 2;

template <class T>
void check_image(const Image<T>& image, const char* what) {
  if (image.rows() == image_height_px && image.cols() == image_width_px) return;
  throw UsageError(std::string(what) + " of a Kinect v2 has 512 x 424 pixels, got " +
                   std::to_string(image.cols()) + " x " + std::to_string(image.rows()));
}

/// The phase as a float in [0, 1). Rounding to float may give a whole cycle, which is phase 0.
float whole_cycles_removed(double cycles) {
  const auto phase = static_cast<float>(cycles - std::floor(cycles));
  return phase < 1 ? phase : 0.0F;
}

struct PixelPhase {
  float phase;
  float amplitude;
};

/// Phase and amplitude from three steps that are not saturated. The arguments are `steps[k]` = m_k,
/// the value of the P0 table, and the factor of the amplitude.
PixelPhase pixel_phase(const std::array<int, 3>& steps, int p0, double factor) {
  // I and Q at p = 0, with the cosines 1, -1/2, -1/2 and the sines 0, √3/2, -√3/2. Steps that are
  // equal give exactly 0.
  const double i = steps[0] - 0.5 * (steps[1] + steps[2]);
  const double q = sin_120_deg * (steps[2] - steps[1]);
  if (i == 0 && q == 0) return {nan, 0};
  const double cycles = std::atan2(q, i) / rad_per_cycle + cycles_per_p0_unit * p0;
  return {whole_cycles_removed(cycles), static_cast<float>(factor * 2 / 3 * std::hypot(i, q))};
}

std::int16_t measured(double value) {
  const double rounded = std::round(value);
  return std::abs(rounded) > largest_magnitude ? saturated_measurement
                                               : static_cast<std::int16_t>(rounded);
}

}  // namespace

Phases phases_from_measurements(const Measurements& measurements, const P0Tables& p0) {
  Phases result;
  for (std::size_t f = 0; f < frequencies_hz.size(); ++f) {
    const Steps& steps = measurements.steps[f];
    for (const Image<std::int16_t>& step : steps) check_image(step, "a measurement");
    check_image(p0.tables[f], "a P0 table");
    result.phase[f].setConstant(image_height_px, image_width_px, nan);
    result.amplitude[f].setConstant(image_height_px, image_width_px, saturated_amplitude);
    result.saturated[f].setOnes(image_height_px, image_width_px);
    for (Eigen::Index i = 0; i < steps[0].size(); ++i) {
      const std::array<int, 3> pixel{steps[0].data()[i], steps[1].data()[i], steps[2].data()[i]};
      if (std::ranges::find(pixel, saturated_measurement) != pixel.end()) continue;
      const auto [phase, amplitude] =
          pixel_phase(pixel, p0.tables[f].data()[i], amplitude_factors[f]);
      result.phase[f].data()[i] = phase;
      result.amplitude[f].data()[i] = amplitude;
      result.saturated[f].data()[i] = 0;
    }
  }
  return result;
}

Measurements measurements_from_phases(const std::array<ImageF, 3>& phase,
                                      const std::array<ImageF, 3>& amplitude, const P0Tables& p0) {
  Measurements measurements;
  for (std::size_t f = 0; f < frequencies_hz.size(); ++f) {
    check_image(phase[f], "a phase image");
    check_image(amplitude[f], "an amplitude image");
    check_image(p0.tables[f], "a P0 table");
    for (std::size_t k = 0; k < 3; ++k) {
      Image<std::int16_t>& image = measurements.steps[f][k];
      image.setZero(image_height_px, image_width_px);
      for (Eigen::Index i = 0; i < image.size(); ++i) {
        const double a = amplitude[f].data()[i];
        const double cycles = phase[f].data()[i] - cycles_per_p0_unit * p0.tables[f].data()[i];
        if (a >= saturated_amplitude) {
          image.data()[i] = saturated_measurement;
        } else if (a > 0 && std::isfinite(cycles)) {
          const double step = static_cast<double>(k) / 3;
          image.data()[i] =
              measured(a / amplitude_factors[f] * std::cos(rad_per_cycle * (cycles + step)));
        }
      }
    }
  }
  return measurements;
}

}  // namespace tofmap::kinect2
