// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "residual_fit.hpp"

#include "median.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <tofmap/core/median.hpp>
#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/diagonal_layout.hpp>

namespace tofmap {
namespace {

/// How far the residuals of one frame may lie off what all frames together say.
constexpr double prior_constant_m = 0.03;

/// Samples of one surface err alike: so many count as one that is independent.
constexpr double correlated_samples = 30;

/// What is left of systematic errors before any is known.
constexpr double unknown_systematic_m = 0.04;

constexpr int lanes = DiagonalLayout::lanes;

/// Σ a b c.
TOFMAP_VECTOR_CLONES float dot(int count, const float* a, const float* b) {
  std::array<float, lanes> sums{};
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
#pragma GCC ivdep
    for (int k = 0; k < lanes; ++k) sums[static_cast<std::size_t>(k)] += a[i + k] * b[i + k];
  }
  float sum = 0;
  for (const float lane : sums) sum += lane;
  for (; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

/// Geman and McClure's weights over the variance; 0 where there is no residual.
TOFMAP_VECTOR_CLONES void fill_weights(int count, const float* error_m, const float* variance_m2,
                                       float systematic_m2, float* weight) {
  constexpr float square_sigmas = 9;
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) {
    const float variance = variance_m2[i] + systematic_m2;
    const float share = 1 / (1 + error_m[i] * error_m[i] / (square_sigmas * variance));
    weight[i] = error_m[i] == error_m[i] ? share * share / variance : 0.0F;
  }
}

/// Number by number: weighted products of all pairs of columns, and of each with `right`.
template <int terms>
void add_products(const std::array<const float*, terms>& columns, const std::vector<float>& weight,
                  const std::vector<float>& right, Eigen::Matrix<double, terms, terms>& information,
                  Eigen::Matrix<double, terms, 1>& gradient) {
  const auto count = static_cast<int>(weight.size());
  std::vector<float> weighted(weight.size());
  for (int a = 0; a < terms; ++a) {
    const float* column = columns[static_cast<std::size_t>(a)];
    for (std::size_t i = 0; i < weight.size(); ++i) weighted[i] = weight[i] * column[i];
    for (int b = 0; b <= a; ++b) {
      information(a, b) += dot(count, weighted.data(), columns[static_cast<std::size_t>(b)]);
      information(b, a) = information(a, b);
    }
    gradient[a] += dot(count, weighted.data(), right.data());
  }
}

/// The factors of the camera's coefficients, number by number.
std::vector<std::vector<float>> camera_terms(const SurfaceSamples& samples,
                                             const std::vector<float>& phase_b,
                                             double reference_amplitude) {
  std::vector<std::vector<float>> terms(ErrorTracker::terms,
                                        std::vector<float>(samples.size(), 0.0F));
  constexpr float turn = 2 * std::numbers::pi_v<float>;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    terms.front()[i] = 1;
    if (std::isnan(phase_b[i])) continue;
    const std::array<float, 2> base_cosine{std::cos(turn * samples.phase_a[i]),
                                           std::cos(turn * phase_b[i])};
    const std::array<float, 2> base_sine{std::sin(turn * samples.phase_a[i]),
                                         std::sin(turn * phase_b[i])};
    std::array<float, 2> cosine = base_cosine;
    std::array<float, 2> sine = base_sine;
    for (std::size_t k = 1; k <= CameraErrors::harmonics; ++k) {
      for (std::size_t f = 0; f < 2; ++f) {
        terms[4 * k - 3 + 2 * f][i] = cosine[f];
        terms[4 * k - 2 + 2 * f][i] = sine[f];
        const float next = cosine[f] * base_cosine[f] - sine[f] * base_sine[f];
        sine[f] = sine[f] * base_cosine[f] + cosine[f] * base_sine[f];
        cosine[f] = next;
      }
    }
    if (!samples.amplitude_a.empty()) {
      terms.back()[i] =
          std::log10(samples.amplitude_a[i] / static_cast<float>(reference_amplitude));
    }
  }
  return terms;
}

}  // namespace

ResidualFit::ResidualFit(const SurfaceSamples& samples, const ExposurePair& pair,
                         const PairGeometry& geometry, const CameraErrors& camera,
                         const MotionPrior& prior)
    : samples_(&samples),
      pair_(&pair),
      geometry_(&geometry),
      camera_(camera),
      prior_(prior),
      table_(camera),
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

void ResidualFit::find_motion(const Eigen::Vector3d& rotation_rad, bool any_constant) {
  motion_.rotation_rad = rotation_rad;
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
  table_ = CameraErrorTable(camera);
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

/// Phases B where the motion puts the samples.
void ResidualFit::look_up() {
  look_up_samples(*samples_, range_m_, *pair_, *geometry_, motion_, seen_);
  predict();
}

void ResidualFit::predict() {
  const auto size = static_cast<int>(samples_->size());
  const float* amplitude = samples_->amplitude_a.empty() ? nullptr : samples_->amplitude_a.data();
  predict_camera_errors(table_, size, samples_->phase_a.data(), seen_.phase_b.data(), amplitude,
                        predicted_m_.data());
  const auto constant = static_cast<float>(constant_m_);
  for (std::size_t i = 0; i < predicted_m_.size(); ++i) {
    predicted_m_[i] += seen_.shift_m[i] + constant;
  }
}

void ResidualFit::associate() {
  find_nearest(geometry_->limits, static_cast<int>(samples_->size()), samples_->phase_a.data(),
               seen_.phase_b.data(), predicted_m_.data(), error_m_.data(), range_m_.data());
}

/// The constant, nearest to zero, that most of some samples agree on.
void ResidualFit::find_constant() {
  constexpr std::size_t enough = 300;
  constexpr double spacing_m = 0.01;
  constexpr float clearly_better = 1.05F;
  const std::size_t stride = 1 + samples_->size() / enough;
  std::vector<float> phase_a;
  std::vector<float> phase_b;
  std::vector<float> predicted;
  std::vector<float> variance;
  for (std::size_t i = 0; i < samples_->size(); i += stride) {
    if (std::isnan(seen_.phase_b[i])) continue;
    phase_a.push_back(samples_->phase_a[i]);
    phase_b.push_back(seen_.phase_b[i]);
    predicted.push_back(predicted_m_[i]);
    variance.push_back(seen_.variance_m2[i] +
                       static_cast<float>(unknown_systematic_m * unknown_systematic_m));
  }
  std::vector<float> shifted(predicted.size());
  std::vector<float> error(predicted.size());
  std::vector<float> range(predicted.size());
  const double reach_m = residual_step_m(geometry_->limits) / 2;
  float best = 0;
  for (int k = 0; (k + 1) / 2 * spacing_m < reach_m; ++k) {
    const double tried_m = (k % 2 == 1 ? 1 : -1) * (k + 1) / 2 * spacing_m;
    for (std::size_t i = 0; i < shifted.size(); ++i) {
      shifted[i] = predicted[i] + static_cast<float>(tried_m);
    }
    find_nearest(geometry_->limits, static_cast<int>(shifted.size()), phase_a.data(),
                 phase_b.data(), shifted.data(), error.data(), range.data());
    float score = 0;
    for (std::size_t i = 0; i < error.size(); ++i) {
      score += std::exp(-error[i] * error[i] / (2 * variance[i]));
    }
    if (score > clearly_better * best) {
      best = score;
      constant_m_ = tried_m;
    }
  }
  predict();
}

void ResidualFit::weigh(double systematic_m) {
  // However well residuals agree: no pixel is worth a thousand others.
  constexpr double least_m = 0.005;
  systematic_m = std::max(systematic_m, least_m);
  fill_weights(static_cast<int>(weight_.size()), error_m_.data(), seen_.variance_m2.data(),
               static_cast<float>(systematic_m * systematic_m), weight_.data());
}

/// Equation 17: how the residual changes with the motion.
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
  MotionVector so_far;
  so_far << motion_.translation_m, motion_.rotation_rad;
  information.diagonal() += precision;
  gradient -= precision.cwiseProduct(so_far);
}

/// One step of Gauss and Newton for the motion and, if wanted, the constant.
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
  add_products<unknowns>(columns, weight_, errors, information, gradient);
  information /= correlated_samples;
  gradient /= correlated_samples;

  MotionMatrix of_motion = information.topLeftCorner<motion_terms, motion_terms>();
  MotionVector motion_gradient = gradient.head<motion_terms>();
  add_motion_prior(of_motion, motion_gradient);
  information.topLeftCorner<motion_terms, motion_terms>() = of_motion;
  gradient.head<motion_terms>() = motion_gradient;
  constexpr double fixed = 1e9;
  const double precision = with_constant ? 1 / (prior_constant_m * prior_constant_m) : fixed;
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
  const auto terms = camera_terms(*samples_, seen_.phase_b, camera_.reference_amplitude);
  std::array<const float*, all> columns{};
  for (std::size_t k = 0; k < of_camera; ++k) columns[k] = terms[k].data();
  for (std::size_t k = 0; k < motion_terms; ++k) columns[of_camera + k] = jacobian_[k].data();
  // The residual without motion: what is left of it, and what is predicted of it besides.
  std::vector<float> right(samples_->size());
  for (std::size_t i = 0; i < right.size(); ++i) {
    right[i] = std::isnan(error_m_[i]) ? 0.0F : error_m_[i] + predicted_m_[i] - seen_.shift_m[i];
  }
  Eigen::Matrix<double, all, all> products = Eigen::Matrix<double, all, all>::Zero();
  Eigen::Matrix<double, all, 1> with_right = Eigen::Matrix<double, all, 1>::Zero();
  add_products<all>(columns, weight_, right, products, with_right);
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

double ResidualFit::motion_cost() const {
  return motion_.translation_m.squaredNorm() / (2 * prior_.translation_m * prior_.translation_m) +
         motion_.rotation_rad.squaredNorm() / (2 * prior_.rotation_rad * prior_.rotation_rad);
}

double ResidualFit::cost(double systematic_m) const {
  constexpr float square_sigmas = 9;
  const auto systematic_m2 = static_cast<float>(systematic_m * systematic_m);
  double sum = 0;
  for (std::size_t i = 0; i < error_m_.size(); ++i) {
    const float variance = seen_.variance_m2[i] + systematic_m2;
    const float square = error_m_[i] * error_m_[i] / variance;
    // Geman and McClure's; a sample that B did not see costs as much as one that does not fit.
    sum += std::isnan(square) ? square_sigmas / 2 : square / 2 / (1 + square / square_sigmas);
  }
  return sum / correlated_samples + motion_cost();
}

double ResidualFit::periodic_rms_m() const {
  std::vector<float> periodic_m(samples_->size());
  predict_camera_errors(table_, static_cast<int>(periodic_m.size()), samples_->phase_a.data(),
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
  return flow.empty() ? 0 : double{median_of_positive(flow)};
}

double ResidualFit::median_amplitude_ratio() const {
  std::vector<float> ratios;
  for (std::size_t i = 0; i < seen_.amplitude_ratio.size(); ++i) {
    if (!std::isnan(error_m_[i])) ratios.push_back(seen_.amplitude_ratio[i]);
  }
  return ratios.empty() ? 1 : double{median_of_positive(ratios)};
}

}  // namespace tofmap
