// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// The errors of the ranges of one frame. A measure is NaN if no pixel counts for it.
struct RangeScore {
  double wrong_wrap_percent = 0;  ///< pixels off by more than λ_A / 2, of those with a range
  double coverage_percent = 0;    ///< pixels with a range, of those with a return and a known truth
  double range_rmse_m = 0;        ///< RMS error of the pixels with a right wrap
};

/// Compares a range image with true radial ranges, in metres; a true range is unknown if it is
/// negative or not finite. Pixels without a return (reason no_return) or a known truth do not
/// count. Throws UsageError if the sizes differ.
RangeScore score_ranges(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m);

/// The mean of each measure over the frames where it is not NaN. NaN if there are none.
RangeScore mean_score(const std::vector<RangeScore>& frames);

/// Errors by true range, over any number of frames.
class ErrorsOverRange {
 public:
  static constexpr double bin_m = 0.5;  ///< width of a bin

  /// Adds the pixels of a frame, counted as by score_ranges().
  void add(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m);

  /// Adds the pixels of other frames.
  void add(const ErrorsOverRange& others);

  /// The errors of the pixels whose true range is in a bin.
  struct Bin {
    double range_m = 0;             ///< middle of the bin
    std::int64_t pixels = 0;        ///< number of pixels with a range
    double wrong_wrap_percent = 0;  ///< pixels off by more than λ_A / 2
    double range_rmse_m = 0;        ///< RMS error of the other pixels; NaN if there are none
  };

  /// The bins that have pixels, in order of range.
  std::vector<Bin> bins() const;

 private:
  struct Sums {
    std::int64_t pixels = 0;
    std::int64_t wrong = 0;
    double square_m2 = 0;
  };
  std::vector<Sums> sums_;
};

}  // namespace tofmap
