// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// How right the ranges of one frame are. NaN where there is nothing to be right or wrong.
struct RangeScore {
  double wrong_wrap_percent = 0;  ///< of the pixels with a range: off by more than λ_A / 2
  double coverage_percent = 0;    ///< of the pixels with a return and a known truth: have a range
  double range_rmse_m = 0;        ///< of those that are not wrong
};

/// Compares a range image with true radial ranges (metres; unknown if not finite or negative).
/// Pixels that have no return (reason no_return) or no truth do not count. Throws UsageError if
/// sizes differ.
RangeScore score_ranges(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m);

/// Mean over frames, of each measure over those that have it; NaN if none has.
RangeScore mean_score(const std::vector<RangeScore>& frames);

/// Errors by how far away the surface truly is, over any number of frames.
class ErrorsOverRange {
 public:
  static constexpr double bin_m = 0.5;  ///< how wide a bin is

  /// Adds a frame; pixels and errors count as in score_ranges.
  void add(const RangeImage& image, const ImageF& truth_m, double wavelength_a_m);

  /// Adds what other frames gave.
  void add(const ErrorsOverRange& others);

  struct Bin {
    double range_m = 0;       ///< its middle
    std::int64_t pixels = 0;  ///< with a range
    double wrong_wrap_percent = 0;
    double range_rmse_m = 0;  ///< of those that are not wrong; NaN if there is none
  };

  /// Those with a pixel, the nearest first.
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
