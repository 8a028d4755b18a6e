// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "common/counted_ranges.hpp"

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// The planes of a range image that depend on the wrap count.
struct Planes {
  float* range_m;
  float* sigma_m;
  float* confidence;
  std::uint8_t* reason;
};

/// Fills the planes: the range is (range + n · per_count) · scale, its standard deviation is
/// sigma · scale.
TOFMAP_VECTOR_CLONES void fill_counted(int pixels, const float* range, const float* sigma,
                                       const std::uint8_t* counts, const float* confidence,
                                       float per_count, float scale, const Planes& out_) {
  const Planes out = out_;
#pragma GCC ivdep
  for (int i = 0; i < pixels; ++i) {
    const bool is_valid = counts[i] != invalid_wrap_count;
    const float range_m = (range[i] + static_cast<float>(counts[i]) * per_count) * scale;
    out.range_m[i] = is_valid ? range_m : nan;
    out.sigma_m[i] = is_valid ? sigma[i] * scale : nan;
    out.confidence[i] = is_valid ? confidence[i] : 0.0F;
    out.reason[i] =
        static_cast<std::uint8_t>(is_valid ? InvalidReason::none : InvalidReason::no_return);
  }
}

RangeImage counted(const ImageF& range, const ImageF& sigma, const ImageU8& counts,
                   const ImageF& confidence, float per_count, float scale) {
  RangeImage image;
  for (ImageF* plane : {&image.range_m, &image.sigma_m, &image.confidence}) {
    plane->resize(counts.rows(), counts.cols());
  }
  image.reason.resize(counts.rows(), counts.cols());
  image.wrap_count = counts;
  fill_counted(
      static_cast<int>(counts.size()), range.data(), sigma.data(), counts.data(), confidence.data(),
      per_count, scale,
      {image.range_m.data(), image.sigma_m.data(), image.confidence.data(), image.reason.data()});
  return image;
}

}  // namespace

RangeImage make_range_image(const ImageF& range_m, const ImageF& sigma_m, const ImageU8& counts,
                            const ImageF& confidence) {
  return counted(range_m, sigma_m, counts, confidence, 0, 1);
}

RangeImage make_range_image(const ImageF& phase, const ImageF& sigma_cycles, const ImageU8& counts,
                            const ImageF& confidence, double wavelength_m) {
  return counted(phase, sigma_cycles, counts, confidence, 1, static_cast<float>(wavelength_m));
}

}  // namespace tofmap
