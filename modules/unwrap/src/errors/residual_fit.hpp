// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "errors/exposure_alignment.hpp"
#include "errors/exposure_pair.hpp"
#include "errors/residual_samples.hpp"

#include <optional>
#include <vector>

#include <Eigen/Core>

#include <tofmap/unwrap/errors/error_tracker.hpp>

namespace tofmap {

/// How far a camera is thought to move between two exposures: standard deviations.
struct MotionPrior {
  double translation_m;
  double rotation_rad;
};

/// Exposures that follow each other at once, and exposures a frame apart, both held by hand.
inline constexpr MotionPrior prompt_exposures{0.01, 0.006};
inline constexpr MotionPrior late_exposures{0.06, 0.06};

/// Explains the residuals of samples by motion, by what is known of the camera, and by a constant
/// of this frame: robust, iterated least squares, in which each sample takes the count that fits
/// what is predicted of it best (docs/unwrapping.md, equations 17 to 20).
class ResidualFit {
 public:
  /// Keeps references to all arguments but `camera`.
  ResidualFit(const SurfaceSamples& samples, const ExposurePair& pair, const PairGeometry& geometry,
              const CameraErrors& camera, const MotionPrior& prior);

  /// Also fits the apparent rotation between the exposures, from now on.
  void expect(const ApparentRotation& apparent) { apparent_ = apparent; }

  /// Finds the motion, from `start` on. With `any_constant` the camera's offset is in warning,
  /// too, as on a first frame: the likeliest constant is looked for.
  void find_motion(const ExposureMotion& start, bool any_constant);

  /// The same from the motion found so far on, with other knowledge of the camera.
  void refine(const CameraErrors& camera);

  /// What the samples say of the camera's coefficients, whatever the motion was: the information
  /// that they give, and its product with the coefficients. Samples count as if all were
  /// independent.
  void add_camera_equations(ErrorTracker::TermsMatrix& information,
                            ErrorTracker::Terms& gradient) const;

  const ExposureMotion& motion() const { return motion_; }
  /// What this frame's residuals are larger than predicted, all alike.
  double constant_m() const { return constant_m_; }
  /// Standard deviation of the residuals, noise apart; robust.
  double systematic_m() const { return systematic_m_; }
  /// How badly the motion fits its prior and the apparent rotation, nats.
  double motion_cost() const { return prior_cost() + apparent_cost(); }
  /// How badly residuals, amplitudes and motion fit, nats: what tells one explanation from another.
  /// Infinite if B saw none of the samples.
  /// `systematic_m` is what residuals have besides noise, the same for all that are compared.
  double cost(double systematic_m) const {
    return cost_without_apparent(systematic_m) + apparent_cost();
  }
  /// The same, whatever the apparent rotation is.
  double cost_without_apparent(double systematic_m) const;
  /// Standard deviation over the samples of what is predicted of them as periodic.
  double periodic_rms_m() const;
  /// The share of the samples that B saw as predicted.
  double support() const;
  /// By how far the motion shifts the image, pixels: nine of ten samples by less.
  double flow_px() const;
  /// Median of B's amplitude over A's; 1 without amplitudes.
  double amplitude_gain() const { return amplitude_gain_; }

 private:
  static constexpr int motion_terms = 6;
  using MotionVector = Eigen::Matrix<double, motion_terms, 1>;
  using MotionMatrix = Eigen::Matrix<double, motion_terms, motion_terms>;

  /// Of the apparent rotation: how it changes with the motion, what the motion leaves of it, and
  /// the inverse of its covariance.
  struct ApparentEquations {
    Eigen::Matrix<double, 3, motion_terms> by_motion;
    Eigen::Vector3d off_rad;
    Eigen::Matrix3d information;
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
  std::vector<float> range_m_;      ///< by the count that fits best; 0 before any was found
  std::vector<float> predicted_m_;  ///< of the residual, by all that is known
  std::vector<float> error_m_;      ///< residual minus prediction; NaN where B saw nothing
  std::vector<float> weight_;
  std::vector<std::vector<float>> jacobian_;  ///< of the residual by the motion, number by number
};

}  // namespace tofmap
