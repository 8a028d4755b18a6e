// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/errors/error_tracker.hpp"

#include "errors/constant_search.hpp"
#include "errors/exposure_alignment.hpp"
#include "errors/exposure_matching.hpp"
#include "errors/median.hpp"
#include "errors/residual_fit.hpp"
#include "errors/residual_samples.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>

#include <tofmap/core/bytes.hpp>

namespace tofmap {
namespace {

using Terms = ErrorTracker::Terms;
using TermsMatrix = ErrorTracker::TermsMatrix;

/// Prior standard deviations of the coefficients of CameraErrors.
constexpr double prior_offset_m = 0.06;
constexpr double prior_harmonic_m = 0.012;
constexpr double prior_per_decade_m = 0.01;

/// The samples of a frame have correlated errors: this many count as one independent sample when
/// later frames are predicted.
constexpr double correlated_samples = 30;

/// The same number when the frame itself is predicted, to which its own samples fit better.
constexpr double correlated_samples_of_own = 6;

/// Factor by which the information of earlier frames decays per frame: a memory of about 50 frames.
constexpr double memory = 0.98;

/// Frames with fewer samples are not fitted.
constexpr std::size_t least_samples = 100;

/// If the image moves by at most this much, B sees the same surface as A in every pixel.
constexpr double still_px = 0.7;

/// Share of the samples that are as predicted (ResidualFit::support) above which a fit is good.
constexpr double good_support = 0.8;

/// With a smaller share, a fit is not used to learn or to match.
constexpr double least_support = 0.5;

/// Standard deviation of the systematic errors of a camera before a frame was good enough to learn
/// from.
constexpr double unknown_systematic_m = 0.03;

/// Until this many frames are known, each frame is fitted several times.
constexpr int first_frames = 5;

Terms prior_precision() {
  Terms precision = Terms::Constant(1 / (prior_harmonic_m * prior_harmonic_m));
  precision[0] = 1 / (prior_offset_m * prior_offset_m);
  precision[ErrorTracker::terms - 1] = 1 / (prior_per_decade_m * prior_per_decade_m);
  return precision;
}

std::optional<ApparentRotation> apparent_rotation(const ExposurePair& pair,
                                                  const CameraModel& camera) {
  if (!pair.has_amplitude()) return std::nullopt;
  return align_exposures(pair.amplitude_a, pair.amplitude_b, camera);
}

/// The motion to start a search from: the apparent rotation, if there is one, without translation.
ExposureMotion turned(const std::optional<ApparentRotation>& apparent) {
  ExposureMotion start;
  if (apparent) start.rotation_rad = apparent->rotation_rad;
  return start;
}

/// Whether a fit with the prior of prompt exposures may have missed a larger motion: residuals fit
/// badly, all are off by a constant, or the motion is larger than its prior expects.
bool may_have_moved(const ResidualFit& fit) {
  constexpr double much_systematic_m = 0.012;
  constexpr double much_constant_m = 0.02;
  constexpr double much_nats = 1;
  return fit.support() < good_support || fit.systematic_m() > much_systematic_m ||
         std::abs(fit.constant_m()) > much_constant_m || fit.motion_cost() > much_nats;
}

/// A fit is better than another if its cost is lower by this much.
constexpr double clearly_nats = 2;

/// The standard deviation of residuals besides noise with which two fits are compared.
double compared_systematic_m(const ResidualFit& one, const ResidualFit& other) {
  constexpr double least_systematic_m = 0.01;
  return std::max(least_systematic_m, std::min(one.systematic_m(), other.systematic_m()));
}

/// Whether the first fit explains the residuals clearly better than the second.
bool explains_better(const ResidualFit& one, const ResidualFit& other) {
  const double systematic_m = compared_systematic_m(one, other);
  return one.cost(systematic_m) + clearly_nats < other.cost(systematic_m);
}

/// The same comparison without the apparent rotation, which may be wrong.
bool explains_better_without_apparent(const ResidualFit& one, const ResidualFit& other) {
  const double systematic_m = compared_systematic_m(one, other);
  return one.cost_without_apparent(systematic_m) + clearly_nats <
         other.cost_without_apparent(systematic_m);
}

/// The most likely coefficients, given their prior and the normal equations of the frames.
Terms solve(TermsMatrix information, const Terms& gradient) {
  information.diagonal() += prior_precision();
  return information.ldlt().solve(gradient);
}

void set_coefficients(const Terms& terms, CameraErrors& errors) {
  std::copy_n(terms.data(), ErrorTracker::terms, errors.coefficient_m.begin());
}

/// Median of the positive amplitudes; 1 if there are none.
double median_amplitude(const ImageF& amplitude) {
  std::vector<float> lit;
  for (const float a : amplitude.reshaped()) {
    if (a > 0) lit.push_back(a);
  }
  return lit.empty() ? 1 : double{median_of_positive(lit)};
}

}  // namespace

ErrorTracker::ErrorTracker(const PairLimits& limits, const CameraModel& camera)
    : limits_(limits), camera_(camera) {
  if (camera.width_px > 0 && camera.fx_px > 0) rays_ = pixel_rays(camera);
}

ErrorTracker::Tracked ErrorTracker::track(const Frame& frame, const PhaseSigma& sigma,
                                          std::size_t b, const std::optional<Expected>& expected) {
  const PixelRays no_rays;
  const ImageF no_amplitude;
  const bool has_amplitude = frame.has_amplitude();
  const PairGeometry geometry{limits_, camera_,
                              same_size(rays_.x, frame.phases[0]) ? rays_ : no_rays};
  const ExposurePair pair{
      frame.phases[0], has_amplitude ? frame.amplitudes[0] : no_amplitude, sigma.cycles[0],
      frame.phases[b], has_amplitude ? frame.amplitudes[b] : no_amplitude, sigma.cycles[b]};
  if (camera_errors_.frames == 0 && has_amplitude) {
    camera_errors_.reference_amplitude = median_amplitude(pair.amplitude_a);
  }
  Tracked tracked{{}, unmatched(pair)};
  tracked.errors.camera = camera_errors_;
  const SurfaceSamples samples = gather_samples(pair, geometry, residual_step_m(limits_));
  if (samples.size() >= least_samples) {
    tracked.errors = explain(samples, pair, geometry, expected);
  } else if (camera_errors_.frames == 0) {
    tracked.errors.camera.systematic_m = unknown_systematic_m;
  }
  if (tracked.errors.flow_px <= still_px) {
    match_still_exposure(pair, geometry, tracked.errors.camera,
                         {tracked.errors.motion, tracked.errors.flow_px}, tracked.b);
  } else {
    match_moved(samples, pair, geometry, tracked);
  }
  last_ = {pair.phase_b, pair.amplitude_b, pair.sigma_b_cycles, tracked.errors.motion};
  return tracked;
}

/// Fits the motion of a frame, unless it is expected. `is_late` says whether exposures were late so
/// far, then whether they are.
ResidualFit ErrorTracker::fit_motion(const SurfaceSamples& samples, const ExposurePair& pair,
                                     const PairGeometry& geometry,
                                     const std::optional<Expected>& expected, bool& is_late) const {
  const bool is_first = camera_errors_.frames == 0;
  if (expected && geometry.knows_camera()) {
    ResidualFit fit(samples, pair, geometry, camera_errors_,
                    expected_motion(expected->motion, expected->share));
    fit.find_motion(expected->motion, is_first);
    is_late = expected->is_late;
    return fit;
  }
  ResidualFit fit(samples, pair, geometry, camera_errors_, prompt_exposures);
  fit.find_motion({}, is_first);
  if (!geometry.knows_camera() || (!is_late && !may_have_moved(fit))) return fit;
  ResidualFit moved(samples, pair, geometry, camera_errors_, late_exposures);
  ResidualFit going_on = moved;
  const auto apparent = apparent_rotation(pair, camera_);
  if (apparent) {
    fit.expect(*apparent);
    moved.expect(*apparent);
  }
  moved.find_motion(turned(apparent), true);
  if (is_late) {
    // Cameras tend to continue their motion. If a camera turns towards what it passes, the image
    // hardly moves and alignment sees no motion; alignment may also confuse similar textures.
    going_on.find_motion(last_.motion, true);
    if (explains_better_without_apparent(going_on, moved)) moved = going_on;
  }
  is_late = is_late ? !explains_better(fit, moved) : explains_better(moved, fit);
  return is_late ? moved : fit;
}

/// Estimates the motion and the errors of a frame, and updates the camera's errors with them.
FrameErrors ErrorTracker::explain(const SurfaceSamples& samples, const ExposurePair& pair,
                                  const PairGeometry& geometry,
                                  const std::optional<Expected>& expected) {
  bool is_late = camera_errors_.late_frames > 0;  // cameras tend to stay late
  ResidualFit fit = fit_motion(samples, pair, geometry, expected, is_late);

  // Errors for this frame: its own samples in addition to the earlier frames. While few frames are
  // known, this is repeated, since better errors let more samples find their right wrap counts.
  CameraErrors own = camera_errors_;
  TermsMatrix information;
  Terms gradient;
  const int passes = camera_errors_.frames < first_frames ? 3 : 1;
  for (int pass = 0; pass < passes; ++pass) {
    information.setZero();
    gradient.setZero();
    fit.add_camera_equations(information, gradient);
    set_coefficients(solve(memory * information_ + information / correlated_samples_of_own,
                           memory * gradient_ + gradient / correlated_samples_of_own),
                     own);
    fit.refine(own);
  }
  if (fit.support() >= least_support && information.allFinite() && gradient.allFinite()) {
    learn(information / correlated_samples, gradient / correlated_samples, fit);
    camera_errors_.late_frames = is_late ? camera_errors_.late_frames + 1 : 0;
  }

  FrameErrors errors;
  errors.camera = own;
  errors.motion = fit.motion();
  errors.flow_px = fit.flow_px();
  errors.support = fit.support();
  errors.pixels = static_cast<int>(samples.size());
  errors.camera.coefficient_m[0] += fit.constant_m();
  errors.camera.amplitude_gain = fit.amplitude_gain();
  errors.camera.periodic_rms_m = camera_errors_.periodic_rms_m;
  errors.camera.systematic_m = std::max(fit.systematic_m(), camera_errors_.systematic_m);
  errors.camera.frames = camera_errors_.frames;
  return errors;
}

/// Updates the camera's errors with the normal equations and the fit of a frame.
void ErrorTracker::learn(const TermsMatrix& information, const Terms& gradient,
                         const ResidualFit& fit) {
  information_ = memory * information_ + information;
  gradient_ = memory * gradient_ + gradient;
  set_coefficients(solve(information_, gradient_), camera_errors_);
  take_smaller_offset(fit);
  constexpr int longest_mean = 20;
  const double share = 1.0 / std::min(camera_errors_.frames + 1, longest_mean);
  const double before_m2 = camera_errors_.systematic_m * camera_errors_.systematic_m;
  const double now_m2 = fit.systematic_m() * fit.systematic_m();
  camera_errors_.systematic_m = std::sqrt((1 - share) * before_m2 + share * now_m2);
  const double periodic_m = fit.periodic_rms_m();
  camera_errors_.periodic_rms_m =
      std::sqrt((1 - share) * camera_errors_.periodic_rms_m * camera_errors_.periodic_rms_m +
                share * periodic_m * periodic_m);
  camera_errors_.amplitude_gain += share * (fit.amplitude_gain() - camera_errors_.amplitude_gain);
  ++camera_errors_.frames;
}

/// Replaces an offset beyond the searched interval by the one that is a residual step nearer to
/// zero, unless the fit is clearly worse with it. Both offsets explain residuals equally well, with
/// other wrap counts in all pixels, unless surfaces are so near that their wrap counts cannot be
/// reduced. The smaller offset is more likely: the first frame may have taken the larger one while
/// its motion was poorly known.
void ErrorTracker::take_smaller_offset(const ResidualFit& fit) {
  const double offset_m = camera_errors_.offset_m();
  if (std::abs(offset_m) <= largest_constant_m(limits_)) return;
  const Terms gradient =
      gradient_ - information_.col(0) * std::copysign(residual_step_m(limits_), offset_m);
  CameraErrors smaller = camera_errors_;
  set_coefficients(solve(information_, gradient), smaller);
  ResidualFit with_smaller = fit;
  with_smaller.refine(smaller);
  if (explains_better(fit, with_smaller)) return;
  gradient_ = gradient;
  camera_errors_ = smaller;
}

/// Matches B to A if the image has moved by pixels between them. If B is exposed late, the previous
/// frame's B may have been taken from a nearer position, and show surfaces that this frame's B does
/// not see. Then both are used, first the one with the larger support.
void ErrorTracker::match_moved(const SurfaceSamples& samples, const ExposurePair& pair,
                               const PairGeometry& geometry, Tracked& tracked) {
  const CameraErrors& camera = tracked.errors.camera;
  const auto match_own = [&] {
    match_exposure(pair, geometry, camera, {tracked.errors.motion, tracked.errors.flow_px},
                   tracked.b);
  };
  const bool has_last = same_size(last_.phase, pair.phase_b) && pair.has_amplitude();
  if (!has_last || camera_errors_.late_frames == 0) return match_own();
  const ExposurePair with_last{pair.phase_a, pair.amplitude_a, pair.sigma_a_cycles,
                               last_.phase,  last_.amplitude,  last_.sigma_cycles};
  ResidualFit last(samples, with_last, geometry, camera, late_exposures);
  const auto apparent = apparent_rotation(with_last, camera_);
  if (apparent) last.expect(*apparent);
  last.find_motion(turned(apparent), false);
  if (last.support() < least_support) return match_own();
  const auto match_last = [&] {
    match_exposure(with_last, geometry, camera, {last.motion(), last.flow_px()}, tracked.b);
  };
  tracked.errors.used_last_b = true;
  if (last.support() > tracked.errors.support) {
    match_last();
    match_own();
  } else {
    match_own();
    match_last();
  }
}

void ErrorTracker::save(ByteWriter& out) const {
  tofmap::save(camera_errors_, out);
  out.numbers({information_.data(), terms * terms});
  out.numbers({gradient_.data(), terms});
  for (const ImageF* image : {&last_.phase, &last_.amplitude, &last_.sigma_cycles}) {
    out.image(*image);
  }
  out.numbers({last_.motion.translation_m.data(), 3});
  out.numbers({last_.motion.rotation_rad.data(), 3});
}

void ErrorTracker::load(ByteReader& in) {
  camera_errors_ = camera_errors_in(in);
  in.numbers({information_.data(), terms * terms});
  in.numbers({gradient_.data(), terms});
  for (ImageF* image : {&last_.phase, &last_.amplitude, &last_.sigma_cycles}) {
    *image = in.image<float>(camera_.height_px, camera_.width_px);
  }
  in.numbers({last_.motion.translation_m.data(), 3});
  in.numbers({last_.motion.rotation_rad.data(), 3});
}

}  // namespace tofmap
