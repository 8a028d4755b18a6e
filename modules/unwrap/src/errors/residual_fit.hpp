// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_alignment.hpp"
#include "errors/exposure_pair.hpp"
#include "errors/residual_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

/// Mean and standard deviations of the camera's motion between two exposures.
struct MotionPrior {
  double translation_m;
  double rotation_rad;
  ExposureMotion mean = {};
};

/// For a hand-held camera whose exposures follow each other immediately.
inline const MotionPrior prompt_exposures{0.01, 0.006};

/// For a hand-held camera whose exposures are up to a frame period apart.
inline const MotionPrior late_exposures{0.06, 0.06};

/// For an exposure near others whose motion is known: cameras move almost uniformly within a frame.
/// `share` is the time to this exposure by the time in which the motion was found; beyond 1 its
/// error grows with it.
inline MotionPrior expected_motion(const ExposureMotion& mean, double share) {
  const double growth = std::max(1.0, std::abs(share));
  return {0.002 * growth, 0.001 * growth, mean};
}

/// Explains the inter-frequency residuals of samples by the motion between the exposures, by the
/// known errors of the camera, and by a constant of this frame. The fit is iteratively reweighted
/// least squares, in which each sample takes the wrap count that fits its prediction best
/// (docs/unwrapping.md, equations 17 to 20).
class ResidualFit {
 public:
  /// Keeps references to `samples`, `pair` and `geometry`.
  ResidualFit(const SurfaceSamples& samples, const ExposurePair& pair, const PairGeometry& geometry,
              const CameraErrors& camera, const MotionPrior& prior);

  /// From now on, uses the apparent rotation between the exposures as one more measurement.
  void expect(const ApparentRotation& apparent) { apparent_ = apparent; }

  /// Finds the motion, starting from `start`. With `any_constant`, the constant is searched for,
  /// too, and fitted together with the motion: for frames on which the camera's offset is
  /// uncertain, such as the first one.
  void find_motion(const ExposureMotion& start, bool any_constant);

  /// Continues the fit from the motion found so far, with other errors of the camera.
  void refine(const CameraErrors& camera);

  /// Adds the normal equations for the coefficients of CameraErrors, with the motion marginalised
  /// out: the information matrix and its product with the coefficients. Samples count as if all
  /// were independent.
  void add_camera_equations(ErrorTracker::TermsMatrix& information,
                            ErrorTracker::Terms& gradient) const;

  const ExposureMotion& motion() const { return motion_; }
  /// The constant by which all residuals of this frame are larger than predicted.
  double constant_m() const { return constant_m_; }
  /// Robust standard deviation of the residual errors, with the noise subtracted.
  double systematic_m() const { return systematic_m_; }
  /// Cost of the motion by its prior and the apparent rotation, nats.
  double motion_cost() const { return prior_cost() + apparent_cost(); }
  /// Cost of residuals, amplitudes and motion, nats. Fits of one frame can be compared by their
  /// cost if `systematic_m`, the standard deviation of the residuals besides noise, is the same for
  /// all. Infinite if B saw none of the samples.
  double cost(double systematic_m) const {
    return cost_without_apparent(systematic_m) + apparent_cost();
  }
  /// The same cost without that of the apparent rotation.
  double cost_without_apparent(double systematic_m) const;
  /// Standard deviation over the samples of the periodic error predicted for them.
  double periodic_rms_m() const;
  /// Share of the samples whose residual and amplitude at B are as predicted, 0 … 1.
  double support() const;
  /// 90th percentile, over the samples, of the image shift that the motion causes, pixels.
  double flow_px() const;
  /// Median of B's amplitude over A's; 1 without amplitudes.
  double amplitude_gain() const { return amplitude_gain_; }

 private:
  static constexpr int motion_terms = 6;
  using MotionVector = Eigen::Matrix<double, motion_terms, 1>;
  using MotionMatrix = Eigen::Matrix<double, motion_terms, motion_terms>;

  /// The apparent rotation as a linear measurement of the motion.
  struct ApparentEquations {
    Eigen::Matrix<double, 3, motion_terms> by_motion;  ///< its derivative by the motion
    Eigen::Vector3d off_rad;      ///< measured minus predicted apparent rotation
    Eigen::Matrix3d information;  ///< inverse of its covariance
  };

  void look_up();
  void predict();
  void associate();
  void find_constant();
  void weigh(double systematic_m);
  void step(bool with_constant);
  double constant_sigma_m() const;
  double prior_cost() const;
  double apparent_cost() const;
  double light_cost() const;
  double spread() const;
  double median_amplitude_ratio() const;
  void fill_jacobian();
  void add_motion_prior(MotionMatrix& information, MotionVector& gradient) const;
  ApparentEquations apparent_equations() const;
  MotionVector motion_so_far() const;

  const SurfaceSamples* samples_;
  const ExposurePair* pair_;
  const PairGeometry* geometry_;
  CameraErrors camera_;
  MotionPrior prior_;
  std::optional<ApparentRotation> apparent_;
  ExposureMotion motion_;
  double constant_m_ = 0;
  double systematic_m_;
  double amplitude_gain_ = 1;
  SeenSamples seen_;
  std::vector<float> range_m_;      ///< A's range at the wrap count that fits best
  std::vector<float> predicted_m_;  ///< predicted residual
  std::vector<float> error_m_;      ///< residual minus prediction; NaN where B saw nothing
  std::vector<float> weight_;
  /// Derivatives of the residuals by the motion: one vector over the samples per motion parameter.
  std::vector<std::vector<float>> jacobian_;
};

}  // namespace tofmap
