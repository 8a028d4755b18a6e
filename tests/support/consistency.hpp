// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include <Eigen/Cholesky>

namespace tofmap::test {

/// Monte Carlo consistency of an estimator: the mean over draws of the normalised estimation error
/// squared eᵀ P⁻¹ e of errors e that the estimator says have the covariance P. If that is true and
/// the errors are Gaussian, the sum over N draws of n unknowns is chi-squared with N n degrees of
/// freedom (Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and
/// Navigation, 2001, section 5.4).
class Consistency {
 public:
  template <class Vector, class Matrix>
  void add(const Vector& error, const Matrix& covariance) {
    add_distance(std::sqrt(error.dot(covariance.ldlt().solve(error))),
                 static_cast<int>(error.size()));
  }

  void add(double error, double sigma) { add_distance(error / sigma, 1); }

  /// The Mahalanobis distance of an error of this many unknowns.
  void add_distance(double distance, int unknowns) {
    unknowns_ = unknowns;
    sum_ += distance * distance;
    ++draws_;
  }

  double mean_nees() const { return sum_ / draws_; }

  /// A consistent estimator's mean lies between these bounds in all but one of a thousand cases:
  /// quantiles of chi-squared by Wilson and Hilferty (1931).
  double lower_bound() const { return bound(-3.29); }
  double upper_bound() const { return bound(3.29); }

 private:
  double bound(double sigmas) const {
    const double spread = 2 / (9 * draws_ * unknowns_);
    return unknowns_ * std::pow(1 - spread + sigmas * std::sqrt(spread), 3);
  }

  double unknowns_ = 0;
  double sum_ = 0;
  int draws_ = 0;
};

}  // namespace tofmap::test
