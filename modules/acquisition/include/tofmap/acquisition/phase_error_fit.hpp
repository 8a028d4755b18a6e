// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include <tofmap/acquisition/camera_calibration.hpp>

namespace tofmap {

/// A value and the standard deviation of its error.
struct Estimate {
  double value = 0;
  double sigma = 0;
};

/// Linear least squares, a sample at a time.
class LeastSquares {
 public:
  explicit LeastSquares(int unknowns);

  void add(const Eigen::VectorXd& row, double value);

  int samples() const { return samples_; }

  /// Throws UsageError if the samples do not determine all unknowns. Neighbouring samples share
  /// errors: `correlated` of them count as one independent one.
  std::vector<Estimate> solve(double correlated) const;

  /// Root mean square of what the solution leaves.
  double residual_rms() const;

 private:
  Eigen::MatrixXd information_;
  Eigen::VectorXd gradient_;
  double squares_ = 0;
  int samples_ = 0;
};

/// What one frequency measures too far, from samples of it against known ranges.
class PhaseErrorFit {
 public:
  /// Harmonics of these orders, and an offset.
  explicit PhaseErrorFit(std::vector<int> orders);

  void add(double phase_cycles, double error_m);

  /// The offset, and those harmonics whose amplitude is above four standard deviations. Throws
  /// UsageError if the phases do not cover the cycle.
  PhaseError solve() const;

  int samples() const { return equations_.samples(); }
  double residual_rms_m() const { return equations_.residual_rms(); }

 private:
  std::vector<int> orders_;
  LeastSquares equations_;
};

/// What both frequencies measure too far, from how they disagree, without known ranges. Both are
/// taken to have the same harmonics in cycles, as electronics that drive both have. Offsets that
/// both share cannot be seen.
class BeatErrorFit {
 public:
  BeatErrorFit(std::vector<int> orders, const Modulation& modulation);

  /// `difference_m`: the range at A less that at B.
  void add(double phase_a_cycles, double phase_b_cycles, double difference_m);

  struct Result {
    PhaseError error_a;
    PhaseError error_b;
    Estimate offset_m;  ///< of A less that of B; motion between both images is in it, too
  };

  /// As above; offsets of the errors are zero.
  Result solve() const;

  int samples() const { return equations_.samples(); }
  double residual_rms_m() const { return equations_.residual_rms(); }

 private:
  std::vector<int> orders_;
  Modulation modulation_;
  LeastSquares equations_;
};

}  // namespace tofmap
