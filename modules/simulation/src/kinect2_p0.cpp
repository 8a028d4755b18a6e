// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/simulation/kinect2_p0.hpp"

#include "noise.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include <tofmap/acquisition/kinect2/packet.hpp>
#include <tofmap/core/modulation.hpp>

namespace tofmap {
namespace {

using kinect2::image_height_px;
using kinect2::image_width_px;

constexpr double common_length_m = 0.3316;
constexpr double pattern_peak_m = 0.020;
constexpr double pixel_sigma_m = 0.002;
constexpr double frequency_sigma_m = 0.001;

/// The values of columns 0 and 511, in the order of the frequencies.
constexpr std::array<std::uint16_t, 3> edge_values{0x2c9a, 0x08ec, 0x42e8};

/// A smooth pattern over the image: a wave along each side, with periods of one to three times the
/// side. Between -pattern_peak_m and pattern_peak_m.
class SmoothPattern {
 public:
  explicit SmoothPattern(std::uint64_t key) : share_(0.3 + 0.4 * share_of(key)) {
    for (std::size_t i = 0; i < 2; ++i) {
      periods_[i] = 1 + 2 * share_of(key + 1 + i);
      starts_[i] = share_of(key + 3 + i);
    }
  }

  double at_m(int u, int v) const {
    const double across = wave(0, static_cast<double>(u) / image_width_px);
    const double down = wave(1, static_cast<double>(v) / image_height_px);
    return pattern_peak_m * (share_ * across + (1 - share_) * down);
  }

 private:
  double wave(std::size_t i, double position) const {
    return std::sin(2 * std::numbers::pi * (position / periods_[i] + starts_[i]));
  }

  double share_;
  std::array<double, 2> periods_{};  ///< in sides of the image
  std::array<double, 2> starts_{};   ///< in cycles
};

}  // namespace

kinect2::P0Tables synthetic_p0_tables(int seed) {
  const std::uint64_t key = mix(static_cast<std::uint64_t>(seed));
  const SmoothPattern pattern(mix(key + 1));
  kinect2::P0Tables p0;
  for (std::size_t f = 0; f < p0.tables.size(); ++f) {
    const double wavelength_m = speed_of_light_m_per_s / (2 * kinect2::frequencies_hz[f]);
    const std::uint64_t frequency_key = mix(key + 3 + f);
    ImageU16& table = p0.tables[f];
    table.resize(image_height_px, image_width_px);
    for (int v = 0; v < image_height_px; ++v) {
      for (int u = 0; u < image_width_px; ++u) {
        const auto pixel = static_cast<std::uint64_t>(v * image_width_px + u);
        const double length_m = common_length_m + pattern.at_m(u, v) +
                                pixel_sigma_m * complex_noise(key + 2, pixel).real() +
                                frequency_sigma_m * complex_noise(frequency_key, pixel).real();
        const double cycles = length_m / wavelength_m;
        table(v, u) = static_cast<std::uint16_t>(std::lround(cycles / kinect2::cycles_per_p0_unit));
      }
    }
    table.col(0).setConstant(edge_values[f]);
    table.col(image_width_px - 1).setConstant(edge_values[f]);
  }
  return p0;
}

}  // namespace tofmap
