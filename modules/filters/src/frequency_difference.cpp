// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "frequency_difference.hpp"

#include "size_check.hpp"

#include <algorithm>
#include <cmath>

#include <tofmap/core/error.hpp>
#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// One row of a frame, of its wrap counts and of its rays.
struct FrameRow {
  const float* phase_a;
  const float* phase_b;
  const float* amplitude_a;
  const float* amplitude_b;
  const float* range_m;
  const float* ray_z;
  const std::uint8_t* wrap_count;
};

/// Calculates the differences of a row, and their variances for the noise scale 1. Terms times 0
/// make them NaN where an input is NaN, without branches.
TOFMAP_VECTOR_CLONES void fill_difference(int pixels, const FrameRow& from_, float wavelength_a_m,
                                          float wavelength_b_m, float* value, float* variance) {
  const FrameRow from = from_;
  const float wavelengths_b = wavelength_a_m / wavelength_b_m;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const float cycles_a = from.phase_a[i] + static_cast<float>(from.wrap_count[i]);
    const float phase_b = from.phase_b[i];
    const bool is_present = cycles_a == cycles_a && phase_b == phase_b;
    const float wrapped = frequency_residual_cycles(is_present ? cycles_a : 0.0F,
                                                    is_present ? phase_b : 0.0F, wavelengths_b) +
                          0 * cycles_a + 0 * phase_b;
    const float sigma_a = wavelength_a_m / from.amplitude_a[i];
    const float sigma_b = wavelength_b_m / from.amplitude_b[i];
    const float z = from.ray_z[i];
    const float absent = 0 * from.range_m[i];
    value[i] = wrapped * wavelength_b_m * z + absent;
    variance[i] = (sigma_a * sigma_a + sigma_b * sigma_b) * z * z + absent;
  }
}

/// The frequency, but the first, with the shortest wavelength.
std::size_t most_precise_other(const Modulation& modulation) {
  const auto highest =
      std::max_element(modulation.frequencies_hz.begin() + 1, modulation.frequencies_hz.end());
  return static_cast<std::size_t>(highest - modulation.frequencies_hz.begin());
}

void check_frame(const RangeImage& image, const Frame& frame) {
  const auto fits = [&](const ImageF& one) { return same_size(image.range_m, one); };
  const bool agree = !frame.phases.empty() && std::ranges::all_of(frame.phases, fits) &&
                     (!frame.has_amplitude() || std::ranges::all_of(frame.amplitudes, fits));
  if (!agree) throw UsageError("filter: image and frame differ in size");
}

}  // namespace

FrequencyDifference::FrequencyDifference(const RangeImage& image, const Frame& frame,
                                         const Modulation& modulation, const PixelRays& rays)
    : rows_(static_cast<int>(image.rows())),
      cols_(static_cast<int>(image.cols())),
      stride_(cols_ + 2 * InverseDepth::margin),
      values_(static_cast<std::size_t>((rows_ + 2 * InverseDepth::margin) * stride_), nan),
      variances_(values_) {
  check_size(image, rays, "filter");
  check_frame(image, frame);
  if (frame.frequencies() == 1) {
    set_equal(image);
    return;
  }
  const std::size_t b = most_precise_other(modulation);
  const std::vector<float> ones(static_cast<std::size_t>(cols_), 1.0F);
  for (int v = 0; v < rows_; ++v) {
    const Eigen::Index first = v * image.cols();
    const bool is_lit = frame.has_amplitude();
    fill_difference(
        cols_,
        {frame.phases[0].data() + first, frame.phases[b].data() + first,
         is_lit ? frame.amplitudes[0].data() + first : ones.data(),
         is_lit ? frame.amplitudes[b].data() + first : ones.data(), image.range_m.data() + first,
         rays.z.data() + first, image.wrap_count.data() + first},
        static_cast<float>(modulation.wavelength_m(0)),
        static_cast<float>(modulation.wavelength_m(b)), values_.data() + place(v),
        variances_.data() + place(v));
  }
  const double scale = noise_scale();
  const auto scale2 = static_cast<float>(scale * scale);
  for (float& variance : variances_) variance *= scale2;
}

void FrequencyDifference::set_equal(const RangeImage& image) {
  for (int v = 0; v < rows_; ++v) {
    for (int u = 0; u < cols_; ++u) {
      if (!image.valid(v, u)) continue;
      values_[place(v) + static_cast<std::size_t>(u)] = 0;
      variances_[place(v) + static_cast<std::size_t>(u)] = 0;
    }
  }
}

double FrequencyDifference::noise_scale() const {
  // About 4000 differences determine the noise to 2 %.
  constexpr int enough = 4000;
  const int step = std::max(1, rows_ * cols_ / enough);
  std::vector<float> normalised;
  for (int v = step / 2; v < rows_; v += step) {
    for (int u = 0; u + 1 < cols_; ++u) {
      const float variance = this->variance(v)[u] + this->variance(v)[u + 1];
      const float size = std::abs(value(v)[u + 1] - value(v)[u]) / std::sqrt(variance);
      if (std::isfinite(size)) normalised.push_back(size);
    }
  }
  return normalised.empty() ? 0 : sigma_of_median_deviation * median(normalised);
}

}  // namespace tofmap
