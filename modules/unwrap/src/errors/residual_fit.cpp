// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/residual_fit.hpp"

#include "errors/camera_error_terms.hpp"
#include "errors/constant_search.hpp"
#include "errors/median.hpp"
#include "errors/robust_cost.hpp"
#include "errors/weighted_products.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Standard deviation of the constant of a frame once the camera's errors are known.
constexpr double prior_constant_m = 0.03;

/// Standard deviation of the constant of the first frame, which contains the camera's offset.
constexpr double prior_offset_m = 0.06;

/// Samples of one surface have correlated errors: this many count as one independent sample.
constexpr double correlated_samples = 30;

/// Standard deviation of the systematic errors of an unknown camera.
constexpr double unknown_systematic_m = 0.04;

}  // namespace

ResidualFit::ResidualFit(const SurfaceSamples& samples, const ExposurePair& pair,
                         const PairGeometry& geometry, const CameraErrors& camera,
                         const MotionPrior& prior)
    : samples_(&samples),
      pair_(&pair),
      geometry_(&geometry),
      camera_(camera),
      prior_(prior),
      systematic_m_(camera.frames > 0 ? camera.systematic_m : unknown_systematic_m),
      range_m_(samples.size()),
      predicted_m_(samples.size()),
      error_m_(samples.size()),
      weight_(samples.size()),
      jacobian_(motion_terms, std::vector<float>(samples.size(), 0.0F)) {
  for (std::size_t i = 0; i < samples.size(); ++i) {
    range_m_[i] = samples.phase_a[i] * static_cast<float>(geometry.limits.wavelength_a_m);
  }
}

void ResidualFit::find_motion(const ExposureMotion& start, bool any_constant) {
  motion_ = start;
  look_up();
  if (any_constant) find_constant();
  constexpr int rounds = 3;
  double systematic_m = std::max(systematic_m_, unknown_systematic_m);
  for (int round = 0; round < rounds; ++round) {
    associate();
    weigh(systematic_m);
    step(any_constant);
    predict();
    associate();
    weigh(systematic_m);
    step(any_constant);
    look_up();
    associate();
    systematic_m = std::max(0.5 * systematic_m, spread());
  }
  systematic_m_ = spread();
  amplitude_gain_ = median_amplitude_ratio();
  weigh(systematic_m_);
}

void ResidualFit::refine(const CameraErrors& camera) {
  camera_ = camera;
  constant_m_ = 0;
  predict();
  associate();
  weigh(systematic_m_);
  step(false);
  look_up();
  associate();
  weigh(systematic_m_);
  step(true);
  look_up();
  associate();
  systematic_m_ = spread();
  weigh(systematic_m_);
}

/// Reads B at the positions to which the motion moves the samples, and updates the predictions.
void ResidualFit::look_up() {
  look_up_samples(*samples_, range_m_, *pair_, *geometry_, motion_, seen_);
  predict();
}

/// Predicts the residuals from the camera's errors, the motion and the constant.
void ResidualFit::predict() {
  const auto size = static_cast<int>(samples_->size());
  const float* amplitude = samples_->amplitude_a.empty() ? nullptr : samples_->amplitude_a.data();
  predict_camera_errors(camera_, size, samples_->phase_a.data(), seen_.phase_b.data(), amplitude,
                        predicted_m_.data());
  const auto constant = static_cast<float>(constant_m_);
  for (std::size_t i = 0; i < predicted_m_.size(); ++i) {
    predicted_m_[i] += seen_.shift_m[i] + constant;
  }
}

/// Gives each sample the wrap count that fits its prediction best.
void ResidualFit::associate() {
  find_nearest(geometry_->limits, static_cast<int>(samples_->size()), samples_->phase_a.data(),
               seen_.phase_b.data(), predicted_m_.data(), error_m_.data(), range_m_.data());
}

/// Finds the most likely constant from about 300 of the samples.
void ResidualFit::find_constant() {
  constexpr std::size_t enough = 300;
  const std::size_t stride = 1 + samples_->size() / enough;
  PredictedSamples some;
  for (std::size_t i = 0; i < samples_->size(); i += stride) {
    if (std::isnan(seen_.phase_b[i])) continue;
    some.phase_a.push_back(samples_->phase_a[i]);
    some.phase_b.push_back(seen_.phase_b[i]);
    some.predicted_m.push_back(predicted_m_[i]);
    some.variance_m2.push_back(seen_.variance_m2[i]);
    if (!samples_->amplitude_a.empty()) some.amplitude_a.push_back(samples_->amplitude_a[i]);
  }
  // The predictions above do not contain the constant: it was 0 so far.
  constant_m_ =
      likeliest_constant_m(geometry_->limits,
                           {constant_sigma_m(), unknown_systematic_m,
                            std::max(1.0, correlated_samples / static_cast<double>(stride))},
                           some);
  predict();
}

/// Computes the weights of the samples for a standard deviation of the residuals besides noise.
void ResidualFit::weigh(double systematic_m) {
  // A lower limit, so that no pixel gets a thousand times the weight of another.
  constexpr double least_m = 0.005;
  systematic_m = std::max(systematic_m, least_m);
  fill_robust_weights(error_m_, seen_.variance_m2, systematic_m, weight_);
}

/// Fills in the derivatives of the residuals by the motion (docs/unwrapping.md, equation 17).
void ResidualFit::fill_jacobian() {
  if (!geometry_->knows_camera()) return;
  for (std::size_t i = 0; i < samples_->size(); ++i) {
    const Eigen::Vector3f ray(samples_->ray_x[i], samples_->ray_y[i], samples_->ray_z[i]);
    const Eigen::Vector3f gradient(samples_->gradient_x[i], samples_->gradient_y[i],
                                   samples_->gradient_z[i]);
    const Eigen::Vector3f by_translation = ray - gradient / std::max(range_m_[i], 0.1F);
    const Eigen::Vector3f by_rotation = gradient.cross(ray);
    for (std::size_t k = 0; k < 3; ++k) {
      jacobian_[k][i] = by_translation[static_cast<Eigen::Index>(k)];
      jacobian_[k + 3][i] = by_rotation[static_cast<Eigen::Index>(k)];
    }
  }
}

void ResidualFit::add_motion_prior(MotionMatrix& information, MotionVector& gradient) const {
  MotionVector precision;
  precision << Eigen::Vector3d::Constant(1 / (prior_.translation_m * prior_.translation_m)),
      Eigen::Vector3d::Constant(1 / (prior_.rotation_rad * prior_.rotation_rad));
  MotionVector mean;
  mean << prior_.mean.translation_m, prior_.mean.rotation_rad;
  information.diagonal() += precision;
  gradient -= precision.cwiseProduct(motion_so_far() - mean);
  if (!apparent_) return;
  const ApparentEquations apparent = apparent_equations();
  information += apparent.by_motion.transpose() * apparent.information * apparent.by_motion;
  gradient += apparent.by_motion.transpose() * apparent.information * apparent.off_rad;
}

ResidualFit::MotionVector ResidualFit::motion_so_far() const {
  MotionVector so_far;
  so_far << motion_.translation_m, motion_.rotation_rad;
  return so_far;
}

/// Linearises the apparent rotation (docs/unwrapping.md, equation 25). Parallax is that of the mean
/// of 1 / range over the samples.
ResidualFit::ApparentEquations ResidualFit::apparent_equations() const {
  constexpr float nearest_m = 0.3F;
  constexpr double least_translation_m = 0.02;
  double sum = 0;
  double squares = 0;
  for (const float range_m : range_m_) {
    const double nearness = 1 / std::max(range_m, nearest_m);
    sum += nearness;
    squares += nearness * nearness;
  }
  const double count = std::max<double>(1, static_cast<double>(range_m_.size()));
  const double mean = sum / count;
  const double spread = std::max(squares / count - mean * mean, 0.0);
  ApparentEquations out;
  out.by_motion.setZero();
  out.by_motion.rightCols<3>().setIdentity();
  out.by_motion(0, 1) = -mean;
  out.by_motion(1, 0) = mean;
  out.off_rad = apparent_->rotation_rad - out.by_motion * motion_so_far();
  // Surfaces at other ranges have another parallax, and any of them may dominate the alignment.
  const double translation_m =
      std::max(motion_.translation_m.head<2>().norm(), least_translation_m);
  const Eigen::Matrix3d covariance = apparent_->covariance_rad2 + Eigen::Matrix3d::Identity() *
                                                                      translation_m *
                                                                      translation_m * spread;
  out.information = covariance.inverse();
  return out;
}

/// One Gauss-Newton step for the motion and, with `with_constant`, for the constant.
void ResidualFit::step(bool with_constant) {
  constexpr int unknowns = motion_terms + 1;
  fill_jacobian();
  const std::vector<float> ones(samples_->size(), 1.0F);
  std::array<const float*, unknowns> columns{};
  for (std::size_t k = 0; k < motion_terms; ++k) columns[k] = jacobian_[k].data();
  columns.back() = ones.data();
  Eigen::Matrix<double, unknowns, unknowns> information =
      Eigen::Matrix<double, unknowns, unknowns>::Zero();
  Eigen::Matrix<double, unknowns, 1> gradient = Eigen::Matrix<double, unknowns, 1>::Zero();
  std::vector<float> errors = error_m_;
  for (float& error : errors) error = std::isnan(error) ? 0.0F : error;
  add_weighted_products<unknowns>(columns, weight_, errors, information, gradient);
  information /= correlated_samples;
  gradient /= correlated_samples;

  MotionMatrix of_motion = information.topLeftCorner<motion_terms, motion_terms>();
  MotionVector motion_gradient = gradient.head<motion_terms>();
  add_motion_prior(of_motion, motion_gradient);
  information.topLeftCorner<motion_terms, motion_terms>() = of_motion;
  gradient.head<motion_terms>() = motion_gradient;
  constexpr double fixed = 1e9;
  const double precision = with_constant ? 1 / (constant_sigma_m() * constant_sigma_m()) : fixed;
  information(motion_terms, motion_terms) += precision;
  gradient[motion_terms] -= precision * constant_m_;

  const Eigen::Matrix<double, unknowns, 1> change = information.ldlt().solve(gradient);
  if (!change.allFinite()) return;
  if (geometry_->knows_camera()) {
    motion_.translation_m += change.head<3>();
    const Eigen::AngleAxisd rotation(rotation_matrix(motion_.rotation_rad) *
                                     rotation_matrix(change.segment<3>(3)));
    motion_.rotation_rad = rotation.angle() * rotation.axis();
    for (std::size_t i = 0; i < samples_->size(); ++i) {
      for (std::size_t k = 0; k < motion_terms; ++k) {
        seen_.shift_m[i] +=
            jacobian_[k][i] * static_cast<float>(change[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  constant_m_ += change[motion_terms];
}

/// Robust standard deviation of the residual errors with the noise subtracted.
double ResidualFit::spread() const {
  constexpr std::size_t enough = 50;
  std::vector<float> sizes;
  std::vector<float> variances;
  for (std::size_t i = 0; i < error_m_.size(); ++i) {
    if (std::isnan(error_m_[i])) continue;
    sizes.push_back(std::abs(error_m_[i]));
    variances.push_back(seen_.variance_m2[i]);
  }
  if (sizes.size() < enough) return systematic_m_;
  const double total_m = sigma_of_median_deviation * double{median_of_positive(sizes)};
  const double noise_m2 = median_of_positive(variances);
  return std::sqrt(std::max(total_m * total_m - noise_m2, 0.0));
}

void ResidualFit::add_camera_equations(ErrorTracker::TermsMatrix& information,
                                       ErrorTracker::Terms& gradient) const {
  constexpr int of_camera = ErrorTracker::terms;
  constexpr int all = of_camera + motion_terms;
  const auto terms = camera_error_terms(*samples_, seen_.phase_b, camera_.reference_amplitude);
  std::array<const float*, all> columns{};
  for (std::size_t k = 0; k < of_camera; ++k) columns[k] = terms[k].data();
  for (std::size_t k = 0; k < motion_terms; ++k) columns[of_camera + k] = jacobian_[k].data();
  // The residuals minus the effect of the motion.
  std::vector<float> right(samples_->size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    right[i] = std::isnan(error_m_[i]) ? 0.0F : error_m_[i] + predicted_m_[i] - seen_.shift_m[i];
  }
  Eigen::Matrix<double, all, all> products = Eigen::Matrix<double, all, all>::Zero();
  Eigen::Matrix<double, all, 1> with_right = Eigen::Matrix<double, all, 1>::Zero();
  add_weighted_products<all>(columns, weight_, right, products, with_right);
  MotionMatrix of_motion = products.bottomRightCorner<motion_terms, motion_terms>();
  MotionVector motion_gradient = with_right.tail<motion_terms>();
  add_motion_prior(of_motion, motion_gradient);
  const auto solver = of_motion.ldlt();
  const Eigen::Matrix<double, of_camera, motion_terms> cross =
      products.topRightCorner<of_camera, motion_terms>();
  information +=
      products.topLeftCorner<of_camera, of_camera>() - cross * solver.solve(cross.transpose());
  gradient += with_right.head<of_camera>() - cross * solver.solve(motion_gradient);
}

double ResidualFit::prior_cost() const {
  const double moved_m2 = (motion_.translation_m - prior_.mean.translation_m).squaredNorm();
  const double turned_rad2 = (motion_.rotation_rad - prior_.mean.rotation_rad).squaredNorm();
  return moved_m2 / (2 * prior_.translation_m * prior_.translation_m) +
         turned_rad2 / (2 * prior_.rotation_rad * prior_.rotation_rad);
}

double ResidualFit::apparent_cost() const {
  if (!apparent_) return 0;
  const ApparentEquations apparent = apparent_equations();
  return 0.5 * apparent.off_rad.dot(apparent.information * apparent.off_rad);
}

double ResidualFit::constant_sigma_m() const {
  return camera_.frames > 0 ? prior_constant_m : prior_offset_m;
}

double ResidualFit::cost_without_apparent(double systematic_m) const {
  return (robust_cost(error_m_, seen_.variance_m2, systematic_m) + light_cost()) /
             correlated_samples +
         prior_cost();
}

/// The cost of the differences between A's and B's amplitudes, in nats, as if all samples were
/// independent. A and B see the same surfaces only if the motion is right.
double ResidualFit::light_cost() const {
  if (seen_.amplitude_ratio.empty()) return 0;
  constexpr double light_sigma = 0.15;  // texture varies the logarithm of the ratio by this much
  // The logarithm of an amplitude has the same noise as its phase in radians.
  const double rad_per_m = 2 * std::numbers::pi / geometry_->limits.wavelength_a_m;
  std::vector<float> off(seen_.amplitude_ratio.size());
  std::vector<float> variance(off.size());
  for (std::size_t i = 0; i < off.size(); ++i) {
    const float ratio = seen_.amplitude_ratio[i] / static_cast<float>(amplitude_gain_);
    off[i] = std::log(ratio) + 0 * error_m_[i];
    variance[i] = static_cast<float>(rad_per_m * rad_per_m) * seen_.variance_m2[i];
  }
  return robust_cost(off, variance, light_sigma);
}

double ResidualFit::periodic_rms_m() const {
  std::vector<float> periodic_m(samples_->size());
  predict_camera_errors(camera_, static_cast<int>(periodic_m.size()), samples_->phase_a.data(),
                        seen_.phase_b.data(), nullptr, periodic_m.data());
  double sum = 0;
  double squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < periodic_m.size(); ++i) {
    if (std::isnan(error_m_[i])) continue;
    sum += periodic_m[i];
    squares += periodic_m[i] * periodic_m[i];
    ++count;
  }
  if (count == 0) return 0;
  const double mean = sum / count;
  return std::sqrt(std::max(squares / count - mean * mean, 0.0));
}

double ResidualFit::support() const {
  constexpr float tolerated_m = 0.03F;
  constexpr float sigmas = 3;
  const auto gain = static_cast<float>(amplitude_gain_);
  int good = 0;
  for (std::size_t i = 0; i < error_m_.size(); ++i) {
    if (std::isnan(error_m_[i])) continue;
    const float tolerance_m2 = sigmas * sigmas * (seen_.variance_m2[i] + tolerated_m * tolerated_m);
    const bool is_same_light =
        seen_.amplitude_ratio.empty() || (seen_.amplitude_ratio[i] < same_light_ratio * gain &&
                                          seen_.amplitude_ratio[i] * same_light_ratio > gain);
    good += is_same_light && error_m_[i] * error_m_[i] < tolerance_m2 ? 1 : 0;
  }
  return static_cast<double>(good) / static_cast<double>(std::max<std::size_t>(1, error_m_.size()));
}

double ResidualFit::flow_px() const {
  if (!geometry_->knows_camera() || samples_->size() == 0) return 0;
  std::vector<float> col(samples_->size());
  std::vector<float> row(samples_->size());
  std::vector<float> unused(samples_->size());
  warp(ExposureWarp(geometry_->camera, motion_), static_cast<int>(samples_->size()),
       samples_->ray_x.data(), samples_->ray_y.data(), samples_->ray_z.data(), range_m_.data(),
       col.data(), row.data(), unused.data());
  std::vector<float> flow;
  for (std::size_t i = 0; i < col.size(); ++i) {
    const float across = col[i] - static_cast<float>(samples_->col[i]);
    const float along = row[i] - static_cast<float>(samples_->row[i]);
    if (!std::isnan(across + along)) flow.push_back(std::hypot(across, along));
  }
  if (flow.empty()) return 0;
  const auto most =
      flow.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(flow.size()));
  std::nth_element(flow.begin(), most, flow.end());
  return double{*most};
}

double ResidualFit::median_amplitude_ratio() const {
  std::vector<float> ratios;
  for (std::size_t i = 0; i < seen_.amplitude_ratio.size(); ++i) {
    if (!std::isnan(error_m_[i])) ratios.push_back(seen_.amplitude_ratio[i]);
  }
  return ratios.empty() ? 1 : double{median_of_positive(ratios)};
}

}  // namespace tofmap
