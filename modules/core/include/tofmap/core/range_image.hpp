// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Why a pixel has no range. The numbers are those of `reason/NNNNNN.png`.
enum class InvalidReason : std::uint8_t {
  none = 0,            ///< the pixel is valid
  no_return = 1,       ///< the camera saw no signal at one of the frequencies
  low_amplitude = 2,   ///< the signal is weaker than the filter allows
  low_confidence = 3,  ///< the wrap count is less sure than asked for
  jump_edge = 4,       ///< a flying pixel between two surfaces
  out_of_range = 5,    ///< the range lies outside what is allowed
  ambiguous = 6,       ///< the frequencies cannot tell two equally likely wrap counts apart
  saturated = 7,       ///< the signal is too strong to be measured at one of the frequencies
  isolated_wrap = 8,   ///< a small region whose wrap count fits neither surroundings nor residual
  outlier = 9,         ///< farther from all around it than the image's points mostly are
  free_space_violation = 10,  ///< other views see what is behind it
};

/// The name of a reason, as the documentation spells it.
const char* reason_name(InvalidReason reason);

inline constexpr std::uint8_t invalid_wrap_count = 255;

/// Unwrapped radial ranges. A pixel is valid or invalid in all planes at once.
struct RangeImage {
  ImageF range_m;      ///< radial, metres; NaN where invalid
  ImageF sigma_m;      ///< predicted standard deviation of the noise of range_m; NaN where invalid
  ImageU8 wrap_count;  ///< whole wavelengths of A added; invalid_wrap_count where invalid
  ImageF confidence;   ///< probability that the wrap count is right, 0 … 1; 0 where invalid
  ImageU8 reason;      ///< InvalidReason as a number; 0 where valid
  /// How many pixels' worth of noise a valid range is the mean of, if pixels around it are in it,
  /// too: its noise is not independent of theirs, and one pixel by itself would have the variance
  /// averaged_px · sigma_m². 0 x 0: all pixels are by themselves.
  ImageF averaged_px;
  /// Standard deviation of the error of valid ranges besides noise, metres, as far as the camera
  /// shows it: averaging over pixels and frames does not lower it (tofmap/core/range_error.hpp).
  double systematic_m = 0;

  RangeImage() = default;

  /// All pixels invalid, without a return.
  RangeImage(Eigen::Index rows, Eigen::Index cols);

  Eigen::Index rows() const { return range_m.rows(); }
  Eigen::Index cols() const { return range_m.cols(); }
  bool valid(Eigen::Index row, Eigen::Index col) const { return reason(row, col) == 0; }
  int count_valid() const;

  /// averaged_px, 1 where pixels are by themselves.
  float averaged(Eigen::Index row, Eigen::Index col) const {
    return averaged_px.size() == 0 ? 1.0F : averaged_px(row, col);
  }

  /// Variance of a range, noise and systematic error together; NaN where invalid.
  double variance_m2(Eigen::Index row, Eigen::Index col) const {
    const double noise_m = sigma_m(row, col);
    return noise_m * noise_m + systematic_m * systematic_m;
  }

  /// Makes the pixel invalid in all planes.
  void invalidate(Eigen::Index row, Eigen::Index col, InvalidReason why);
};

/// How many pixels are invalid for this reason.
int count_reason(const RangeImage& image, InvalidReason reason);

}  // namespace tofmap
