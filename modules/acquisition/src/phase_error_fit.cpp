// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/phase_error_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr double least_significance = 4;

/// Pixels of one surface err alike: by lens, by light from elsewhere, by edges.
constexpr double correlated_samples = 30;

double angle_of(int order, double cycles) { return 2 * std::numbers::pi * order * cycles; }

int unknowns_of(const std::vector<int>& orders) { return 1 + 2 * static_cast<int>(orders.size()); }

/// Harmonic k of the solution, if it stands out of its uncertainty.
bool is_significant(const Estimate& cosine, const Estimate& sine) {
  const double amplitude = std::hypot(cosine.value, sine.value);
  return amplitude > least_significance * std::max(cosine.sigma, sine.sigma);
}

}  // namespace

LeastSquares::LeastSquares(int unknowns)
    : information_(Eigen::MatrixXd::Zero(unknowns, unknowns)),
      gradient_(Eigen::VectorXd::Zero(unknowns)) {}

void LeastSquares::add(const Eigen::VectorXd& row, double value) {
  information_.selfadjointView<Eigen::Lower>().rankUpdate(row);
  gradient_ += value * row;
  squares_ += value * value;
  ++samples_;
}

std::vector<Estimate> LeastSquares::solve(double correlated) const {
  const Eigen::MatrixXd information = information_.selfadjointView<Eigen::Lower>();
  const Eigen::LDLT<Eigen::MatrixXd> solver(information);
  constexpr double least_share = 1e-6;  // of what one sample tells
  const bool is_determined =
      samples_ > 0 && solver.isPositive() && solver.vectorD().minCoeff() > least_share * samples_;
  if (!is_determined) {
    throw UsageError("too few samples, or too much alike, to tell " +
                     std::to_string(gradient_.size()) + " unknowns");
  }
  const Eigen::VectorXd solution = solver.solve(gradient_);
  const Eigen::MatrixXd covariance =
      solver.solve(Eigen::MatrixXd::Identity(information.rows(), information.cols()));
  const double variance = std::max(0.0, squares_ - gradient_.dot(solution)) / samples_;
  std::vector<Estimate> estimates;
  for (Eigen::Index i = 0; i < solution.size(); ++i) {
    estimates.push_back({solution[i], std::sqrt(correlated * variance * covariance(i, i))});
  }
  return estimates;
}

double LeastSquares::residual_rms() const {
  const Eigen::MatrixXd information = information_.selfadjointView<Eigen::Lower>();
  const double explained = gradient_.dot(information.ldlt().solve(gradient_));
  return std::sqrt(std::max(0.0, squares_ - explained) / std::max(1, samples_));
}

PhaseErrorFit::PhaseErrorFit(std::vector<int> orders)
    : orders_(std::move(orders)), equations_(unknowns_of(orders_)) {}

void PhaseErrorFit::add(double phase_cycles, double error_m) {
  Eigen::VectorXd row(unknowns_of(orders_));
  row[0] = 1;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const double angle = angle_of(orders_[i], phase_cycles);
    row.segment<2>(1 + 2 * static_cast<Eigen::Index>(i)) << std::cos(angle), std::sin(angle);
  }
  equations_.add(row, error_m);
}

PhaseError PhaseErrorFit::solve() const {
  const std::vector<Estimate> found = equations_.solve(correlated_samples);
  PhaseError error;
  error.offset_m = found[0].value;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const Estimate& cosine = found[1 + 2 * i];
    const Estimate& sine = found[2 + 2 * i];
    if (!is_significant(cosine, sine)) continue;
    error.harmonics.push_back({orders_[i], cosine.value, sine.value});
  }
  return error;
}

BeatErrorFit::BeatErrorFit(std::vector<int> orders, const Modulation& modulation)
    : orders_(std::move(orders)), modulation_(modulation), equations_(unknowns_of(orders_)) {}

void BeatErrorFit::add(double phase_a_cycles, double phase_b_cycles, double difference_m) {
  const double a_m = modulation_.wavelength_a_m();
  const double b_m = modulation_.wavelength_b_m();
  Eigen::VectorXd row(unknowns_of(orders_));
  row[0] = 1;
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const double at_a = angle_of(orders_[i], phase_a_cycles);
    const double at_b = angle_of(orders_[i], phase_b_cycles);
    row.segment<2>(1 + 2 * static_cast<Eigen::Index>(i))
        << a_m * std::cos(at_a) - b_m * std::cos(at_b),
        a_m * std::sin(at_a) - b_m * std::sin(at_b);
  }
  equations_.add(row, difference_m);
}

BeatErrorFit::Result BeatErrorFit::solve() const {
  const std::vector<Estimate> found = equations_.solve(correlated_samples);
  Result result;
  result.offset_m = found[0];
  for (std::size_t i = 0; i < orders_.size(); ++i) {
    const Estimate& cosine = found[1 + 2 * i];
    const Estimate& sine = found[2 + 2 * i];
    if (!is_significant(cosine, sine)) continue;
    const auto in_metres = [&](double wavelength_m) {
      return WiggleHarmonic{orders_[i], wavelength_m * cosine.value, wavelength_m * sine.value};
    };
    result.error_a.harmonics.push_back(in_metres(modulation_.wavelength_a_m()));
    result.error_b.harmonics.push_back(in_metres(modulation_.wavelength_b_m()));
  }
  return result;
}

}  // namespace tofmap
