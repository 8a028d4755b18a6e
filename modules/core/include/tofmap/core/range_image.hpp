// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Why a pixel has no range. `reason/NNNNNN.png` stores the same numbers.
enum class InvalidReason : std::uint8_t {
  none = 0,            ///< the pixel is valid
  no_return = 1,       ///< the camera saw no signal at one of the frequencies
  low_amplitude = 2,   ///< the amplitude is below the limit of the filter
  low_confidence = 3,  ///< the confidence of the wrap count is below the limit
  jump_edge = 4,       ///< a flying pixel between two surfaces
  out_of_range = 5,    ///< the range lies outside the allowed interval
  ambiguous = 6,       ///< the frequencies cannot tell two equally likely wrap counts apart
  saturated = 7,       ///< the signal is too strong to be measured at one of the frequencies
  /// part of a small region whose wrap count fits neither its surroundings nor its residual
  isolated_wrap = 8,
  outlier = 9,                ///< farther from its neighbours than is usual in the image
  free_space_violation = 10,  ///< other frames see through the place of this point
};

/// The name of a reason, as in the documentation and in reports.
const char* reason_name(InvalidReason reason);

/// RangeImage::wrap_count of an invalid pixel.
inline constexpr std::uint8_t invalid_wrap_count = 255;

/// Unwrapped radial ranges. A pixel is either valid in all images or invalid in all of them.
struct RangeImage {
  ImageF range_m;      ///< radial; NaN where invalid
  ImageF sigma_m;      ///< predicted standard deviation of the noise of range_m; NaN where invalid
  ImageU8 wrap_count;  ///< number of whole wavelengths of A; invalid_wrap_count where invalid
  ImageF confidence;   ///< probability that the wrap count is right, 0 … 1; 0 where invalid
  ImageU8 reason;      ///< InvalidReason as a number; 0 where valid
  /// Effective number of pixels whose noise was averaged into a valid range; the unaveraged pixel
  /// would have the variance averaged_px · sigma_m². Where it exceeds 1, the noise is correlated
  /// with that of neighbouring pixels. Empty (0 x 0) if no pixel was averaged.
  ImageF averaged_px;
  /// Estimated standard deviation of the systematic error of valid ranges, metres. Averaging over
  /// pixels and frames does not reduce this error (tofmap/core/range_error.hpp).
  double systematic_m = 0;

  RangeImage() = default;

  /// All pixels are invalid, with the reason `no_return`.
  RangeImage(Eigen::Index rows, Eigen::Index cols);

  Eigen::Index rows() const { return range_m.rows(); }
  Eigen::Index cols() const { return range_m.cols(); }
  bool valid(Eigen::Index row, Eigen::Index col) const { return reason(row, col) == 0; }
  int count_valid() const;

  /// averaged_px of a pixel; 1 if averaged_px is empty.
  float averaged(Eigen::Index row, Eigen::Index col) const {
    return averaged_px.size() == 0 ? 1.0F : averaged_px(row, col);
  }

  /// Variance of the error of a range: noise plus systematic error. NaN where invalid.
  double variance_m2(Eigen::Index row, Eigen::Index col) const {
    const double noise_m = sigma_m(row, col);
    return noise_m * noise_m + systematic_m * systematic_m;
  }

  /// Makes the pixel invalid in all images.
  void invalidate(Eigen::Index row, Eigen::Index col, InvalidReason why);
};

/// Number of pixels that are invalid for this reason.
int count_reason(const RangeImage& image, InvalidReason reason);

}  // namespace tofmap
