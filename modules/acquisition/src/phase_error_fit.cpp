// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/phase_error_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include <Eigen/Cholesky>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

constexpr double least_significance = 4;

/// Pixels of one surface err alike, by lens, by light from elsewhere, by edges: so many count as
/// one that is independent.
constexpr double correlated_pairs = 30;

/// Errors are functions of the phase that is measured, which has them in it: each pass knows them
/// better. After three, an error of a hundredth of a cycle changes by less than its hundredth part.
constexpr int passes = 3;

/// Linear least squares, a sample at a time.
class LeastSquares {
 public:
  explicit LeastSquares(Eigen::Index unknowns)
      : information_(Eigen::MatrixXd::Zero(unknowns, unknowns)),
        gradient_(Eigen::VectorXd::Zero(unknowns)) {}

  void add(const Eigen::VectorXd& row, double value) {
    information_.selfadjointView<Eigen::Lower>().rankUpdate(row);
    gradient_ += value * row;
    squares_ += value * value;
    ++samples_;
  }

  struct Solution {
    std::vector<Estimate> unknowns;
    double residual_rms = 0;
  };

  /// Throws InputError if the samples do not determine all unknowns.
  Solution solve() const {
    const Eigen::MatrixXd information = information_.selfadjointView<Eigen::Lower>();
    const Eigen::LDLT<Eigen::MatrixXd> solver(information);
    constexpr double least_share = 1e-6;  // of what one sample tells
    if (samples_ == 0 || !solver.isPositive() ||
        solver.vectorD().minCoeff() <= least_share * samples_) {
      throw InputError("too few pixels, or too much alike, to tell an offset and " +
                       std::to_string((gradient_.size() - 1) / 2) + " harmonics");
    }
    const Eigen::VectorXd values = solver.solve(gradient_);
    const Eigen::MatrixXd covariance =
        solver.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
    const double variance = std::max(0.0, squares_ - gradient_.dot(values)) / samples_;
    Solution solution{.unknowns = {}, .residual_rms = std::sqrt(variance)};
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      solution.unknowns.push_back(
          {values[i], std::sqrt(correlated_pairs * variance * covariance(i, i))});
    }
    return solution;
  }

 private:
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  double squares_ = 0;
  int samples_ = 0;
};

/// An offset and a cosine and sine of each order: the unknowns of a fit, and their factors.
class HarmonicSeries {
 public:
  explicit HarmonicSeries(const std::vector<int>& orders)
      : orders_(orders), factors_(1 + 2 * static_cast<Eigen::Index>(orders.size())) {}

  Eigen::Index size() const { return factors_.size(); }

  /// Valid until the next call.
  const Eigen::VectorXd& at(double phase_cycles) {
    factors_[0] = 1;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const double angle = 2 * std::numbers::pi * orders_[i] * phase_cycles;
      factors_.segment<2>(1 + 2 * static_cast<Eigen::Index>(i)) << std::cos(angle), std::sin(angle);
    }
    return factors_;
  }

  /// The harmonics that stand out of their uncertainty, times a scale.
  std::vector<WiggleHarmonic> significant(const std::vector<Estimate>& unknowns,
                                          double scale) const {
    std::vector<WiggleHarmonic> harmonics;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const Estimate& cosine = unknowns[1 + 2 * i];
      const Estimate& sine = unknowns[2 + 2 * i];
      if (std::hypot(cosine.value, sine.value) <=
          least_significance * std::max(cosine.sigma, sine.sigma)) {
        continue;
      }
      harmonics.push_back({orders_[i], scale * cosine.value, scale * sine.value});
    }
    return harmonics;
  }

 private:
  std::vector<int> orders_;
  Eigen::VectorXd factors_;
};

using PairValue = std::function<float(const RangePair&)>;

/// The pairs whose value is near the median of all.
std::vector<RangePair> without_outliers(std::span<const RangePair> pairs, double max_error_m,
                                        const PairValue& value_m) {
  std::vector<RangePair> kept;
  if (pairs.empty()) return kept;
  std::vector<float> values_m;
  values_m.reserve(pairs.size());
  std::ranges::transform(pairs, std::back_inserter(values_m), value_m);
  const float middle_m = median(values_m);
  std::ranges::copy_if(pairs, std::back_inserter(kept), [&](const RangePair& pair) {
    return std::abs(value_m(pair) - middle_m) <= max_error_m;
  });
  return kept;
}

struct FrequencyFit {
  PhaseError error;
  double offset_sigma_m = 0;
  double residual_rms_m = 0;
};

/// The errors of one frequency against known ranges. The phase that is measured follows from the
/// known range and the error, without the noise of the measured one.
FrequencyFit fit_frequency(std::span<const RangePair> all, double wavelength_m,
                           float RangePair::*measured_m, const PhaseErrorFitOptions& options) {
  const auto error_of = [measured_m](const RangePair& pair) {
    return pair.*measured_m - pair.reference_m;
  };
  const std::vector<RangePair> pairs = without_outliers(all, options.max_error_m, error_of);
  HarmonicSeries series(options.orders);
  FrequencyFit fit;
  for (int pass = 0; pass < passes; ++pass) {
    LeastSquares equations(series.size());
    for (const RangePair& pair : pairs) {
      const double ideal = pair.reference_m / wavelength_m;
      const double phase = ideal + fit.error.at_m(ideal) / wavelength_m;
      equations.add(series.at(phase), error_of(pair));
    }
    const auto [unknowns, residual_rms] = equations.solve();
    fit.error.offset_m = unknowns[0].value;
    fit.error.harmonics = series.significant(unknowns, 1);
    fit.offset_sigma_m = unknowns[0].sigma;
    fit.residual_rms_m = residual_rms;
  }
  return fit;
}

}  // namespace

void append_range_pairs(const DualFrequencyFrame& frame, const Modulation& modulation,
                        const ImageF& reference_m, int first, int stride,
                        std::vector<RangePair>& pairs) {
  const auto unwrapped = [](float phase_cycles, double wavelength_m, double near_m) {
    const double wraps = std::round(near_m / wavelength_m - double{phase_cycles});
    return static_cast<float>(wavelength_m * (wraps + double{phase_cycles}));
  };
  for (Eigen::Index i = first; i < reference_m.size(); i += stride) {
    const float a = frame.phase_a.data()[i];
    const float b = frame.phase_b.data()[i];
    const float near_m = reference_m.data()[i];
    if (std::isnan(a) || std::isnan(b) || std::isnan(near_m)) continue;
    pairs.push_back({unwrapped(a, modulation.wavelength_a_m(), near_m),
                     unwrapped(b, modulation.wavelength_b_m(), near_m), near_m});
  }
}

PhaseErrorFit fit_to_references(std::span<const RangePair> pairs, const Modulation& modulation,
                                const PhaseErrorFitOptions& options) {
  const FrequencyFit a =
      fit_frequency(pairs, modulation.wavelength_a_m(), &RangePair::a_m, options);
  const FrequencyFit b =
      fit_frequency(pairs, modulation.wavelength_b_m(), &RangePair::b_m, options);
  return {.error_a = a.error,
          .error_b = b.error,
          .offset_m = {a.error.offset_m - b.error.offset_m,
                       std::hypot(a.offset_sigma_m, b.offset_sigma_m)},
          .residual_rms_m = std::hypot(a.residual_rms_m, b.residual_rms_m) / std::numbers::sqrt2};
}

PhaseErrorFit fit_to_beat(std::span<const RangePair> all, const Modulation& modulation,
                          const PhaseErrorFitOptions& options) {
  const double a_m = modulation.wavelength_a_m();
  const double b_m = modulation.wavelength_b_m();
  const auto difference_of = [](const RangePair& pair) { return pair.a_m - pair.b_m; };
  const std::vector<RangePair> pairs = without_outliers(all, options.max_error_m, difference_of);
  HarmonicSeries series_a(options.orders);
  HarmonicSeries series_b(options.orders);
  PhaseErrorFit fit;
  for (int pass = 0; pass < passes; ++pass) {
    LeastSquares equations(series_a.size());
    for (const RangePair& pair : pairs) {
      const double error_a_m = fit.error_a.at_m(pair.a_m / a_m);
      const double error_b_m = fit.error_b.at_m(pair.b_m / b_m);
      // Phases of one range: noise of their own would make them differ, and what they tell less.
      const double range_m = (pair.a_m - error_a_m + pair.b_m - error_b_m) / 2;
      Eigen::VectorXd row = a_m * series_a.at((range_m + error_a_m) / a_m) -
                            b_m * series_b.at((range_m + error_b_m) / b_m);
      row[0] = 1;
      equations.add(row, difference_of(pair));
    }
    const auto [unknowns, residual_rms] = equations.solve();
    fit.error_a.harmonics = series_a.significant(unknowns, a_m);
    fit.error_b.harmonics = series_b.significant(unknowns, b_m);
    fit.offset_m = unknowns[0];
    fit.residual_rms_m = residual_rms;
  }
  return fit;
}

}  // namespace tofmap
