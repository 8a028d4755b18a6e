// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/exposure_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace tofmap {
namespace {

using Eigen::Vector3f;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Neighbours this far apart make the tangents of a surface.
constexpr Eigen::Index reach_px = 2;

Vector3f ray_at(const PixelRays& rays, Eigen::Index v, Eigen::Index u) {
  return {rays.x(v, u), rays.y(v, u), rays.z(v, u)};
}

/// The vector between two pixels; none if either is missing or they are not on one surface.
std::optional<Vector3f> tangent(const ImageF& range_m, const PixelRays& rays, Eigen::Index v0,
                                Eigen::Index u0, Eigen::Index v1, Eigen::Index u1) {
  constexpr float largest_step = 0.15F;  // of the range
  const float from_m = range_m(v0, u0);
  const float to_m = range_m(v1, u1);
  if (!(std::abs(to_m - from_m) < largest_step * from_m)) return std::nullopt;
  return to_m * ray_at(rays, v1, u1) - from_m * ray_at(rays, v0, u0);
}

/// g = n / (n · u) of the surface in a pixel; none where its surroundings are not smooth.
std::optional<Vector3f> surface_gradient(const ImageF& range_m, const PixelRays& rays,
                                         Eigen::Index v, Eigen::Index u) {
  constexpr float steepest = 0.1F;  // cosine of incidence
  if (std::isnan(range_m(v, u))) return std::nullopt;
  const auto first = [](Eigen::Index at) { return std::max<Eigen::Index>(at - reach_px, 0); };
  const auto last = [](Eigen::Index at, Eigen::Index size) {
    return std::min(at + reach_px, size - 1);
  };
  const auto across = tangent(range_m, rays, v, first(u), v, last(u, range_m.cols()));
  const auto along = tangent(range_m, rays, first(v), u, last(v, range_m.rows()), u);
  if (!across || !along) return std::nullopt;
  const Vector3f normal = across->cross(*along);
  const float toward = normal.dot(ray_at(rays, v, u));
  if (!(std::abs(toward) > steepest * normal.norm())) return std::nullopt;
  return normal / toward;
}

/// One equation for the motion.
struct Observation {
  Vector6d jacobian;
  double residual_m;
  double weight;
};

std::vector<Observation> observe(const ImageF& range_m, const ImageF& residual_m,
                                 const ImageF& sigma_m, const PixelRays& rays) {
  constexpr Eigen::Index enough = 4000;
  constexpr double least_sigma_m = 0.01;  // what calibration leaves
  const auto step = static_cast<Eigen::Index>(
      std::sqrt(std::max(1.0, static_cast<double>(range_m.size()) / enough)));
  std::vector<Observation> observations;
  for (Eigen::Index v = 0; v < range_m.rows(); v += step) {
    for (Eigen::Index u = 0; u < range_m.cols(); u += step) {
      if (!std::isfinite(residual_m(v, u))) continue;
      const auto gradient = surface_gradient(range_m, rays, v, u);
      if (!gradient) continue;
      const Vector3f point_m = range_m(v, u) * ray_at(rays, v, u);
      Observation observation;
      observation.jacobian << gradient->cast<double>(), point_m.cross(*gradient).cast<double>();
      observation.residual_m = residual_m(v, u);
      observation.weight = 1 / (sigma_m(v, u) * sigma_m(v, u) + least_sigma_m * least_sigma_m);
      observations.push_back(observation);
    }
  }
  return observations;
}

/// Huber's weight of a residual of so many standard deviations.
double robust_weight(double deviations) {
  constexpr double limit = 1.5;
  return std::abs(deviations) <= limit ? 1 : limit / std::abs(deviations);
}

}  // namespace

ExposureMotion estimate_exposure_motion(const ImageF& range_m, const ImageF& residual_m,
                                        const ImageF& sigma_m, const PixelRays& rays) {
  constexpr std::size_t enough = 200;
  constexpr int rounds = 4;
  const std::vector<Observation> observations = observe(range_m, residual_m, sigma_m, rays);
  ExposureMotion motion;
  if (observations.size() < enough) return motion;
  Vector6d twist = Vector6d::Zero();
  for (int round = 0; round < rounds; ++round) {
    // Without surfaces that tell them apart, directions stay near zero: 10 cm and 0.1 rad are
    // large.
    Matrix6d information = Matrix6d::Identity() / (0.1 * 0.1);
    Vector6d gradient = Vector6d::Zero();
    for (const Observation& o : observations) {
      const double off_m = o.residual_m - o.jacobian.dot(twist);
      const double weight = o.weight * robust_weight(off_m * std::sqrt(o.weight));
      information.selfadjointView<Eigen::Lower>().rankUpdate(o.jacobian, weight);
      gradient += weight * o.residual_m * o.jacobian;
    }
    twist = information.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
  }
  motion.translation_m = twist.head<3>().cast<float>();
  motion.rotation_rad = twist.tail<3>().cast<float>();
  motion.pixels = static_cast<int>(observations.size());
  return motion;
}

ImageF range_shrinkage_m(const ExposureMotion& motion, const ImageF& range_m,
                         const PixelRays& rays) {
  ImageF shrinkage_m = ImageF::Zero(range_m.rows(), range_m.cols());
  for (Eigen::Index v = 0; v < range_m.rows(); ++v) {
    for (Eigen::Index u = 0; u < range_m.cols(); ++u) {
      if (std::isnan(range_m(v, u))) continue;
      const Vector3f ray = ray_at(rays, v, u);
      const Vector3f gradient = surface_gradient(range_m, rays, v, u).value_or(ray);
      const Vector3f displacement =
          motion.translation_m + motion.rotation_rad.cross(range_m(v, u) * ray);
      shrinkage_m(v, u) = gradient.dot(displacement);
    }
  }
  return shrinkage_m;
}

}  // namespace tofmap
