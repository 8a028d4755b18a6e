// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sample_noise.hpp"

#include <complex>
#include <cstddef>
#include <vector>

namespace tofmap {

/// One range error of a pixel.
struct PixelError {
  double error_m = 0;
  double change_m = 0;        ///< of the range until the next frame; 0 if it is unknown
  double relative_noise = 1;  ///< standard deviation of the noise, in an unknown unit
  double weight = 1;
};

/// Weighted sums of the errors of one pixel over the frames.
struct PixelSums {
  int count = 0;
  double weight = 0;
  double sum_m = 0;
  double squares_m2 = 0;
  double sum_of_changes_m = 0;
  double squared_changes_m2 = 0;
  double products_m2 = 0;  ///< of errors and changes
  /// Weighted sum of exp(2πi 4φ), where φ is the phase of the reference.
  std::complex<double> fourth_harmonic = 0;
  PixelError kept;  ///< one of the errors, each with the same probability

  void add(const PixelError& error, std::size_t pixel);

  /// The mean of the errors without the part that is proportional to the changes.
  double mean_m(double delay_frames = 0) const {
    return (sum_m - delay_frames * sum_of_changes_m) / weight;
  }

  /// Weighted sum of the squared deviations from this mean, of the errors without this part.
  double scatter_m2(double delay_frames = 0) const;
};

/// The factor of the changes that explains most of how the errors of each pixel differ from their
/// mean (within estimator of a regression with fixed effects): the delay of the exposure in frame
/// periods. 0 if nothing changes.
double delay_of(const std::vector<PixelSums>& pixels);

/// The noise of single errors, from the deviations of the kept ones from the means of their pixels.
/// Pixels with one error do not count. If there are no others, the unit is 1, so that weights are
/// relative ones.
SampleNoise noise_of(const std::vector<PixelSums>& pixels);

}  // namespace tofmap
