// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/correlation/step_fit.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/SVD>
#include <fmt/format.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Ten times the condition number of evenly spaced angles with an offset.
constexpr double highest_condition_number = 10 * std::numbers::sqrt2;

/// An amplitude below this share of the values is a rounding error of the fit.
constexpr double rounding = 1e-12;

Eigen::MatrixXd model_of(const std::vector<double>& angles_rad, bool with_offset) {
  const auto steps = static_cast<Eigen::Index>(angles_rad.size());
  const auto angles = Eigen::Map<const Eigen::ArrayXd>(angles_rad.data(), steps);
  Eigen::MatrixXd model(steps, with_offset ? 3 : 2);
  if (with_offset) model.col(0).setOnes();
  model.rightCols(2).col(0) = angles.cos();
  model.rightCols(2).col(1) = angles.sin();
  return model;
}

std::string degrees(const std::vector<double>& angles_rad) {
  std::string text;
  for (const double angle_rad : angles_rad) {
    text += (text.empty() ? "" : ", ") + fmt::format("{:.6g}", angle_rad * 180 / std::numbers::pi);
  }
  return text;
}

/// Fits one row of the images. `values` has a row per step and a column per pixel.
void fit_row(const Eigen::MatrixXd& values, const StepDesign& design, Eigen::Index row,
             StepFit& fit) {
  const Eigen::MatrixXd solved = design.solution() * values;
  const auto cosine = solved.bottomRows(2).row(0).array();
  const auto sine = solved.bottomRows(2).row(1).array();
  const Eigen::ArrayXd largest = values.cwiseAbs().colwise().maxCoeff().transpose();
  for (Eigen::Index col = 0; col < values.cols(); ++col) {
    double amplitude = std::hypot(cosine(col), sine(col));
    if (!std::isfinite(amplitude)) continue;
    if (amplitude <= rounding * largest(col)) amplitude = 0;
    fit.amplitude(row, col) = static_cast<float>(amplitude);
    if (amplitude == 0) continue;
    const double angle_rad = design.phase_sign() * std::atan2(sine(col), cosine(col));
    const double cycles = angle_rad / (2 * std::numbers::pi);
    const auto phase = static_cast<float>(cycles - std::floor(cycles));
    fit.phase(row, col) = phase < 1 ? phase : 0;  // rounding may give a whole cycle
  }
  if (design.with_offset()) fit.offset.row(row) = solved.row(0).cast<float>();
  if (design.degrees_of_freedom() == 0) return;
  fit.squared_residual.row(row) =
      (values - design.model() * solved).colwise().squaredNorm().cast<float>();
}

}  // namespace

StepDesign::StepDesign(std::vector<double> angles_rad, bool with_offset, int phase_sign)
    : angles_rad_(std::move(angles_rad)),
      with_offset_(with_offset),
      phase_sign_(phase_sign),
      model_(model_of(angles_rad_, with_offset)) {
  if (phase_sign != 1 && phase_sign != -1) {
    throw UsageError("phase_sign is " + std::to_string(phase_sign) + "; allowed: 1 and -1");
  }
  const Eigen::Index unknowns = model_.cols();
  if (model_.rows() < unknowns) {
    throw InputError("step angles of " + degrees(angles_rad_) + " degrees: at least " +
                     std::to_string(unknowns) + " steps are needed" +
                     (with_offset ? ", or two if there is no offset" : ""));
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(model_, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  const double smallest = singular(unknowns - 1);
  condition_number_ =
      smallest > 0 ? singular(0) / smallest : std::numeric_limits<double>::infinity();
  if (!(condition_number_ <= highest_condition_number)) {
    throw InputError(fmt::format(
        "step angles of {} degrees do not span the circle: the condition number of their fit is "
        "{:.3g}; allowed: at most {:.1f}, ten times that of evenly spaced angles",
        degrees(angles_rad_), condition_number_, highest_condition_number));
  }
  solution_ = svd.solve(Eigen::MatrixXd::Identity(model_.rows(), model_.rows()));
}

StepFit fit_steps(const std::vector<ImageF>& steps, const StepDesign& design) {
  if (static_cast<int>(steps.size()) != design.steps()) {
    throw UsageError(std::to_string(steps.size()) + " correlation images for " +
                     std::to_string(design.steps()) + " step angles");
  }
  for (const ImageF& step : steps) {
    if (!same_size(step, steps.front())) throw UsageError("correlation images differ in size");
  }
  const Eigen::Index rows = steps.front().rows();
  const Eigen::Index cols = steps.front().cols();
  StepFit fit;
  fit.phase = ImageF::Constant(rows, cols, nan);
  fit.amplitude = ImageF::Constant(rows, cols, nan);
  fit.offset = ImageF::Zero(rows, cols);
  if (design.degrees_of_freedom() > 0) fit.squared_residual.resize(rows, cols);
  Eigen::MatrixXd values(design.steps(), cols);
  for (Eigen::Index row = 0; row < rows; ++row) {
    for (int step = 0; step < design.steps(); ++step) {
      values.row(step) = steps[static_cast<std::size_t>(step)].row(row).cast<double>();
    }
    fit_row(values, design, row, fit);
  }
  return fit;
}

}  // namespace tofmap
