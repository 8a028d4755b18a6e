// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/calibration/phase_error_fit.hpp"

#include "sample_noise.hpp"
#include "significance.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

#include <Eigen/Cholesky>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Harmonics below this are left out of fits to the residual, where motion between the two images
/// and mixed pixels cause harmonics of about a millimetre.
constexpr double least_by_residual_m = 0.002;

/// Number of passes. The errors depend on the measured phase, which contains the errors, so each
/// pass refines them. After three passes, an error of 0.01 cycles changes by less than 1 %.
constexpr int passes = 3;

/// Linear least squares that accumulates one sample at a time.
class LeastSquares {
 public:
  explicit LeastSquares(Eigen::Index unknowns)
      : information_(Eigen::MatrixXd::Zero(unknowns, unknowns)),
        gradient_(Eigen::VectorXd::Zero(unknowns)) {}

  /// Adds the equation row · unknowns = value. The weights of all samples must be 1 on average.
  void add(const Eigen::VectorXd& row, double value, double weight) {
    information_.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    gradient_ += weight * value * row;
    squares_ += weight * value * value;
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
    constexpr double least_share = 1e-6;  // of the mean information of a sample
    if (samples_ == 0 || !solver.isPositive() ||
        solver.vectorD().minCoeff() <= least_share * samples_) {
      throw InputError("too few pixels, or too similar phases, to determine an offset and " +
                       std::to_string((gradient_.size() - 1) / 2) +
                       " harmonics; 'tofmap info' shows how many pixels have no return or are "
                       "saturated");
    }
    const Eigen::VectorXd values = solver.solve(gradient_);
    const Eigen::MatrixXd covariance =
        solver.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
    const double variance = std::max(0.0, squares_ - gradient_.dot(values)) / samples_;
    Solution solution{.unknowns = {}, .residual_rms = std::sqrt(variance)};
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      solution.unknowns.push_back(
          {values[i], std::sqrt(correlated_samples * variance * covariance(i, i))});
    }
    return solution;
  }

 private:
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  double squares_ = 0;
  int samples_ = 0;
};

/// The series that is fitted: an offset, and a cosine and a sine of each order.
class HarmonicSeries {
 public:
  explicit HarmonicSeries(const std::vector<int>& orders)
      : orders_(orders), factors_(1 + 2 * static_cast<Eigen::Index>(orders.size())) {}

  /// Number of unknowns.
  Eigen::Index size() const { return factors_.size(); }

  /// The factors of the unknowns at a phase; the reference is valid until the next call. With
  /// noise, they are the expectation over a normal distribution of the phase, without which the
  /// harmonics of noisy samples would be underestimated.
  const Eigen::VectorXd& at(double phase_cycles, double noise_cycles = 0) {
    factors_[0] = 1;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const double rad_per_cycle = 2 * std::numbers::pi * orders_[i];
      const double mean = std::exp(-std::pow(rad_per_cycle * noise_cycles, 2) / 2);
      const double angle = rad_per_cycle * phase_cycles;
      factors_.segment<2>(1 + 2 * static_cast<Eigen::Index>(i)) << mean * std::cos(angle),
          mean * std::sin(angle);
    }
    return factors_;
  }

  /// The harmonics above `least_significance` standard deviations, multiplied by `scale`. Leaves
  /// out those below `least_m` after scaling.
  std::vector<WiggleHarmonic> significant(const std::vector<Estimate>& unknowns, double scale,
                                          double least_m) const {
    std::vector<WiggleHarmonic> harmonics;
    for (std::size_t i = 0; i < orders_.size(); ++i) {
      const Estimate& cosine = unknowns[1 + 2 * i];
      const Estimate& sine = unknowns[2 + 2 * i];
      const double size = std::hypot(cosine.value, sine.value);
      const double sigma = std::max(cosine.sigma, sine.sigma);
      if (size <= least_significance * sigma || scale * size < least_m) continue;
      harmonics.push_back({orders_[i], scale * cosine.value, scale * sine.value});
    }
    return harmonics;
  }

 private:
  std::vector<int> orders_;
  Eigen::VectorXd factors_;
};

/// The value of a sample that is fitted, and the noise of this value in an unknown unit.
struct SampleValue {
  std::function<double(const RangeSample&)> value_m;
  std::function<double(const RangeSample&)> relative_noise;
};

/// A sample with its weight in the fit.
struct WeightedSample {
  RangeSample sample;
  double weight;   ///< 1 on average
  double noise_m;  ///< standard deviation of the noise of the fitted value
};

/// The samples whose value is within `max_error_m` or three standard deviations of the median. With
/// the first limit alone, the kept values of noisy samples would be biased towards the median.
std::vector<WeightedSample> weighted(std::span<const RangeSample> samples, double max_error_m,
                                     const SampleValue& of) {
  if (samples.empty()) return {};
  std::vector<NoisyValue> noisy;
  std::vector<float> values_m;
  for (const RangeSample& sample : samples) {
    values_m.push_back(static_cast<float>(of.value_m(sample)));
    noisy.push_back({static_cast<float>(of.relative_noise(sample)), values_m.back()});
  }
  const SampleNoise noise = estimate_noise(std::move(noisy));
  const double middle_m{median(values_m)};
  constexpr double most_sigmas = 3;
  std::vector<WeightedSample> kept;
  double sum = 0;
  for (const RangeSample& sample : samples) {
    const double relative = of.relative_noise(sample);
    const double limit_m = std::max(max_error_m, most_sigmas * noise.noise_m(relative));
    if (std::abs(of.value_m(sample) - middle_m) > limit_m) continue;
    kept.push_back({sample, noise.weight(relative), noise.noise_m(relative)});
    sum += kept.back().weight;
  }
  for (WeightedSample& one : kept) one.weight *= static_cast<double>(kept.size()) / sum;
  return kept;
}

/// The errors of one frequency.
struct FrequencyFit {
  PhaseError error;
  double offset_sigma_m = 0;
  double residual_rms_m = 0;
};

/// Fits the errors of one frequency to known ranges. Predicts the measured phase from the known
/// range and the errors found so far, because the measured phase itself is noisy.
FrequencyFit fit_frequency(std::span<const RangeSample> all, double wavelength_m,
                           float RangeSample::*measured_m, float RangeSample::*noise,
                           const PhaseErrorFitOptions& options) {
  const SampleValue error{
      [=](const RangeSample& sample) { return double{sample.*measured_m - sample.reference_m}; },
      [=](const RangeSample& sample) { return double{sample.*noise}; }};
  const std::vector<WeightedSample> samples = weighted(all, options.max_error_m, error);
  HarmonicSeries series(options.orders);
  FrequencyFit fit;
  for (int pass = 0; pass < passes; ++pass) {
    LeastSquares equations(series.size());
    for (const WeightedSample& one : samples) {
      const double ideal = one.sample.reference_m / wavelength_m;
      const double phase = ideal + fit.error.at_m(ideal) / wavelength_m;
      equations.add(series.at(phase), error.value_m(one.sample), one.weight);
    }
    const auto [unknowns, residual_rms] = equations.solve();
    fit.error.offset_m = unknowns[0].value;
    fit.error.harmonics = series.significant(unknowns, 1, 0);
    fit.offset_sigma_m = unknowns[0].sigma;
    fit.residual_rms_m = residual_rms;
  }
  return fit;
}

}  // namespace

void append_range_samples(const Frame& frame, const SensorModel& sensor, const ImageF& reference_m,
                          std::size_t b, int first, int stride, std::vector<RangeSample>& samples) {
  if (!same_size(reference_m, frame.phases[0])) {
    throw UsageError("append_range_samples: frame and reference ranges differ in size");
  }
  if (first < 0 || stride < 1) {
    throw UsageError("append_range_samples: first is below 0 or stride below 1");
  }
  const auto unwrapped = [](float phase_cycles, double wavelength_m, double near_m) {
    const double wraps = std::round(near_m / wavelength_m - double{phase_cycles});
    return static_cast<float>(wavelength_m * (wraps + double{phase_cycles}));
  };
  const Modulation& modulation = sensor.modulation;
  const auto is_saturated = [&](Eigen::Index i) {
    return frame.has_amplitude() && sensor.saturation_amplitude > 0 &&
           std::max(frame.amplitudes[0].data()[i], frame.amplitudes[b].data()[i]) >=
               static_cast<float>(sensor.saturation_amplitude);
  };
  for (Eigen::Index i = first; i < reference_m.size(); i += stride) {
    const float phase_a = frame.phases[0].data()[i];
    const float phase_b = frame.phases[b].data()[i];
    const float near_m = reference_m.data()[i];
    if (std::isnan(phase_a) || std::isnan(phase_b) || std::isnan(near_m) || is_saturated(i))
      continue;
    RangeSample sample{unwrapped(phase_a, modulation.wavelength_m(0), near_m),
                       unwrapped(phase_b, modulation.wavelength_m(b), near_m), near_m};
    if (frame.has_amplitude()) {
      const auto noise = [](double wavelength_m, float amplitude) {
        return static_cast<float>(wavelength_m / std::max(1.0, double{amplitude}));
      };
      sample.noise_a = noise(modulation.wavelength_m(0), frame.amplitudes[0].data()[i]);
      sample.noise_b = noise(modulation.wavelength_m(b), frame.amplitudes[b].data()[i]);
    }
    samples.push_back(sample);
  }
}

double agreement_with_references(std::span<const RangeSample> samples,
                                 const Modulation& modulation) {
  const double rad_per_m = 2 * std::numbers::pi / modulation.wavelength_m(0);
  std::complex<double> sum = 0;
  for (const RangeSample& sample : samples) {
    sum += std::polar(1.0, rad_per_m * (double{sample.a_m} - double{sample.reference_m}));
  }
  return std::abs(sum) / static_cast<double>(samples.size());
}

PhaseErrorFit fit_to_references(std::span<const RangeSample> samples, const Modulation& modulation,
                                const PhaseErrorFitOptions& options) {
  const FrequencyFit a = fit_frequency(samples, modulation.wavelength_m(0), &RangeSample::a_m,
                                       &RangeSample::noise_a, options);
  const FrequencyFit b = fit_frequency(samples, modulation.wavelength_m(1), &RangeSample::b_m,
                                       &RangeSample::noise_b, options);
  return {.error_a = a.error,
          .error_b = b.error,
          .offset_sigma_a_m = a.offset_sigma_m,
          .offset_sigma_b_m = b.offset_sigma_m,
          .offset_m = {a.error.offset_m - b.error.offset_m,
                       std::hypot(a.offset_sigma_m, b.offset_sigma_m)},
          .residual_rms_m = std::hypot(a.residual_rms_m, b.residual_rms_m) / std::numbers::sqrt2};
}

PhaseErrorFit fit_to_residual(std::span<const RangeSample> all, const Modulation& modulation,
                              const PhaseErrorFitOptions& options) {
  const double a_m = modulation.wavelength_m(0);
  const double b_m = modulation.wavelength_m(1);
  const SampleValue difference{
      [](const RangeSample& sample) { return double{sample.a_m - sample.b_m}; },
      [](const RangeSample& sample) {
        return std::hypot(double{sample.noise_a}, double{sample.noise_b});
      }};
  const std::vector<WeightedSample> samples = weighted(all, options.max_error_m, difference);
  HarmonicSeries series_a(options.orders);
  HarmonicSeries series_b(options.orders);
  PhaseErrorFit fit;
  for (int pass = 0; pass < passes; ++pass) {
    LeastSquares equations(series_a.size());
    for (const WeightedSample& one : samples) {
      const RangeSample& sample = one.sample;
      const double error_a_m = fit.error_a.at_m(sample.a_m / a_m);
      const double error_b_m = fit.error_b.at_m(sample.b_m / b_m);
      // Both phases are predicted from one range, so that the noise of the single phases does not
      // weaken the fit. The mean of the two ranges has half the noise of their difference.
      const double range_m = (sample.a_m - error_a_m + sample.b_m - error_b_m) / 2;
      const double noise_m = one.noise_m / 2;
      Eigen::VectorXd row = a_m * series_a.at((range_m + error_a_m) / a_m, noise_m / a_m) -
                            b_m * series_b.at((range_m + error_b_m) / b_m, noise_m / b_m);
      row[0] = 1;
      equations.add(row, difference.value_m(sample), one.weight);
    }
    const auto [unknowns, residual_rms] = equations.solve();
    fit.error_a.harmonics = series_a.significant(unknowns, a_m, least_by_residual_m);
    fit.error_b.harmonics = series_b.significant(unknowns, b_m, least_by_residual_m);
    fit.offset_m = unknowns[0];
    fit.residual_rms_m = residual_rms;
  }
  return fit;
}

}  // namespace tofmap
