// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/frame.hpp>
#include <tofmap/core/modulation.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap::test {

inline constexpr double rad_per_deg = std::numbers::pi / 180;

inline CameraModel camera() {
  return {.width_px = 20,
          .height_px = 16,
          .fx_px = 20,
          .fy_px = 20,
          .cx_px = 9.5,
          .cy_px = 7.5,
          .distortion = {}};
}

/// A plane across the view at z = depth.
inline RangeImage plane(double depth_m, float sigma_m = 0.001F) {
  const PixelRays rays = pixel_rays(camera());
  RangeImage image(16, 20);
  image.range_m = static_cast<float>(depth_m) / rays.z;
  image.sigma_m.setConstant(sigma_m);
  image.wrap_count.setZero();
  image.confidence.setConstant(0.9F);
  image.reason.setZero();
  return image;
}

inline Modulation modulation() { return {29e6, 31e6}; }

/// What a camera without noise measures of these ranges; no amplitudes.
inline Frame frame_of(const ImageF& range_m, const Modulation& frequencies = modulation()) {
  Frame frame;
  for (const double wavelength_m : wavelengths_m(frequencies)) {
    const ImageF cycles = range_m / static_cast<float>(wavelength_m);
    frame.phases.push_back(cycles - cycles.floor());
  }
  return frame;
}

/// A plane through (0, 0, depth) that turns away to the right: x sin(slant) = (depth − z)
/// cos(slant) leaves 90° − slant between the optical axis and the plane.
inline RangeImage slanted_plane(double depth_m, double slant_rad) {
  const PixelRays rays = pixel_rays(camera());
  RangeImage image = plane(depth_m);
  const auto s = static_cast<float>(std::sin(slant_rad));
  const auto c = static_cast<float>(std::cos(slant_rad));
  image.range_m = static_cast<float>(depth_m) * c / (rays.z * c + rays.x * s);
  return image;
}

/// Normal noise of the same strength on all ranges, which sigma_m tells of.
inline RangeImage with_noise(const RangeImage& image, float sigma_m, unsigned seed) {
  RangeImage noisy = image;
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma_m);
  for (float& range_m : noisy.range_m.reshaped()) range_m += noise(random);
  noisy.sigma_m.setConstant(sigma_m);
  return noisy;
}

}  // namespace tofmap::test
