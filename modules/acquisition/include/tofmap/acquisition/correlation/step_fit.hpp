// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// How the correlation images of one modulation frequency depend on phase and amplitude.
///
/// The camera correlates the light that returns with a reference signal, which it delays by the
/// angle θ_k in step k. Pixel values are, for a phase φ in cycles and the sign s,
///
///   I_k = b + a cos(2π s φ − θ_k) = b + c cos θ_k + d sin θ_k,
///   c = a cos(2π s φ),  d = a sin(2π s φ),
///
/// where b is the offset (ambient light, dark level) and a the amplitude. In b, c and d this is a
/// linear model, which is fitted to the steps by least squares. For the angles 0°, 90°, 180° and
/// 270° the result is the well-known s φ = atan2(I_1 − I_3, I_0 − I_2) / 2π (Lange and Seitz 2001,
/// 'Solid-state time-of-flight range camera', IEEE Journal of Quantum Electronics 37:390).
///
/// With s = 1 the phase grows with range if the model is right. A camera for which it falls, since
/// I_k = b + a cos(2π φ + θ_k), has s = −1.
class StepDesign {
 public:
  /// `phase_sign` is s, 1 or −1. Without an offset, b is 0: only for images that are differences
  /// and have no dark level. Throws InputError, with angles and condition number, if the angles do
  /// not determine phase and amplitude, or so badly that noise is amplified more than ten times as
  /// much as by evenly spaced angles.
  StepDesign(std::vector<double> angles_rad, bool with_offset, int phase_sign = 1);

  int steps() const { return static_cast<int>(angles_rad_.size()); }
  bool with_offset() const { return with_offset_; }
  int phase_sign() const { return phase_sign_; }

  /// Number of steps minus number of unknowns. If 0, every set of values fits.
  int degrees_of_freedom() const { return steps() - static_cast<int>(model_.cols()); }

  /// Ratio of the largest singular value of the model to the smallest. Evenly spaced angles have
  /// √2 with an offset and 1 without.
  double condition_number() const { return condition_number_; }

  /// The model: a row per step, with the factors of b (unless without offset), c and d.
  const Eigen::MatrixXd& model() const { return model_; }

  /// The pseudo-inverse of the model: times the values of a pixel it gives b, c and d.
  const Eigen::MatrixXd& solution() const { return solution_; }

 private:
  std::vector<double> angles_rad_;
  bool with_offset_ = true;
  int phase_sign_ = 1;
  double condition_number_ = 0;
  Eigen::MatrixXd model_;
  Eigen::MatrixXd solution_;
};

/// Result of fit_steps(). All images have the size of the steps.
struct StepFit {
  /// φ in cycles, [0, 1). NaN where the amplitude is 0 or a value is not finite.
  ImageF phase;
  ImageF amplitude;  ///< a, in units of the values; NaN where a value is not finite
  ImageF offset;     ///< b, in units of the values; 0 without offset
  /// Sum over steps of the squared difference between value and fit, in squared units of the
  /// values. NaN where a value is not finite. Empty if there are no degrees of freedom.
  ImageF squared_residual;
};

/// Fits phase, amplitude and offset of every pixel. `steps` are the values I_k, in the order of the
/// angles. Throws UsageError if their number is not that of the design, or if they differ in size.
StepFit fit_steps(const std::vector<ImageF>& steps, const StepDesign& design);

}  // namespace tofmap
