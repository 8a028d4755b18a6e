// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pixel_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tofmap {
namespace {

/// A number that looks random, from two others (the finaliser of SplitMix64).
std::uint64_t scrambled(std::uint64_t pixel, std::uint64_t count) {
  std::uint64_t bits = (pixel << 32) + count;
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111eb;
  return bits ^ (bits >> 31);
}

}  // namespace

void PixelSums::add(const PixelError& error, std::size_t pixel) {
  ++count;
  weight += error.weight;
  sum_m += error.weight * error.error_m;
  squares_m2 += error.weight * error.error_m * error.error_m;
  sum_of_changes_m += error.weight * error.change_m;
  squared_changes_m2 += error.weight * error.change_m * error.change_m;
  products_m2 += error.weight * error.error_m * error.change_m;
  const auto so_far = static_cast<std::uint64_t>(count);
  if (scrambled(pixel, so_far) % so_far == 0) kept = error;
}

double PixelSums::scatter_m2(double delay_frames) const {
  const double sum_m2 = squares_m2 - 2 * delay_frames * products_m2 +
                        delay_frames * delay_frames * squared_changes_m2;
  const double mean_of_all_m = mean_m(delay_frames);
  return std::max(0.0, sum_m2 - weight * mean_of_all_m * mean_of_all_m);
}

double delay_of(const std::vector<PixelSums>& pixels) {
  double covariance_m2 = 0;
  double variance_m2 = 0;
  for (const PixelSums& pixel : pixels) {
    if (pixel.count < 2) continue;
    covariance_m2 += pixel.products_m2 - pixel.sum_m * pixel.sum_of_changes_m / pixel.weight;
    variance_m2 +=
        pixel.squared_changes_m2 - pixel.sum_of_changes_m * pixel.sum_of_changes_m / pixel.weight;
  }
  return variance_m2 > 0 ? covariance_m2 / variance_m2 : 0;
}

SampleNoise noise_of(const std::vector<PixelSums>& pixels) {
  std::vector<NoisyValue> values;
  for (const PixelSums& pixel : pixels) {
    if (pixel.count < 2) continue;
    // The mean contains the error itself, which brings the two closer together.
    const double share = pixel.kept.weight / pixel.weight;
    const double deviation_m = (pixel.kept.error_m - pixel.mean_m()) / std::sqrt(1 - share);
    values.push_back(
        {static_cast<float>(pixel.kept.relative_noise), static_cast<float>(deviation_m)});
  }
  return values.empty() ? SampleNoise{.unit_m = 1} : estimate_noise(std::move(values));
}

}  // namespace tofmap
