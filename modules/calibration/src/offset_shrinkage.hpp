// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

namespace tofmap {

/// A measured value and the variance of its noise.
struct MeasuredOffset {
  double value = 0;
  double variance = 0;  ///< above 0
};

/// A distribution from which true values are drawn.
struct OffsetDistribution {
  double mean = 0;
  double variance = 0;  ///< 0 if the values differ by no more than their noise explains

  /// The expected true value minus `mean`, given a measured one.
  double shrunk(const MeasuredOffset& measured) const {
    return (measured.value - mean) * variance / (variance + measured.variance);
  }

  /// The variance of the true value, given a measured one.
  double remaining_variance(const MeasuredOffset& measured) const {
    return variance * measured.variance / (variance + measured.variance);
  }
};

/// Estimates the distribution of true values from measured ones by the method of Paule and Mandel
/// (J. Res. NBS 87:377, 1982): the weighted squares of the deviations from the mean, with weights 1
/// / (variance + noise), sum to one less than the number of values.
///
/// The variance is 0 unless the sum for variance 0 (Cochran's Q) exceeds that number by
/// `least_significance` of its standard deviations, where `correlated_samples` values count as one
/// independent value. Without values, mean and variance are 0.
OffsetDistribution distribution_of(std::span<const MeasuredOffset> offsets);

}  // namespace tofmap
