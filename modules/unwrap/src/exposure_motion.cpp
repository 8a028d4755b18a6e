// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/unwrap/exposure_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include <tofmap/core/vector_clones.hpp>
#include <tofmap/unwrap/diagonal_layout.hpp>

namespace tofmap {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Neighbours this far apart make the tangents of a surface.
constexpr int reach_px = 2;

/// Numbers in a row of pixels, three of each.
struct Row3 {
  const float* x;
  const float* y;
  const float* z;
};

/// The points of a row of pixels and their ranges. The first and the last pixel are repeated, so
/// that all pixels have neighbours within reach.
class PointRow {
 public:
  explicit PointRow(Eigen::Index cols) {
    for (std::vector<float>* plane : {&range_m_, &x_, &y_, &z_}) {
      plane->resize(static_cast<std::size_t>(cols + 2 * reach_px));
    }
  }

  void assign(const ImageF& range_m, const PixelRays& rays, Eigen::Index row) {
    const Eigen::Index cols = range_m.cols();
    const Eigen::Index place = row * cols;
    const auto with_repeats = [&](const float* from, std::vector<float>& to) {
      const auto first = std::fill_n(to.begin(), reach_px, from[0]);
      std::fill(std::copy_n(from, cols, first), to.end(), from[cols - 1]);
    };
    with_repeats(range_m.data() + place, range_m_);
    with_repeats(rays.x.data() + place, x_);
    with_repeats(rays.y.data() + place, y_);
    with_repeats(rays.z.data() + place, z_);
    for (std::size_t i = 0; i < range_m_.size(); ++i) {
      x_[i] *= range_m_[i];
      y_[i] *= range_m_[i];
      z_[i] *= range_m_[i];
    }
  }

  /// From `offset` pixels to the right of the row's first one on.
  const float* range_m(int offset) const { return range_m_.data() + reach_px + offset; }
  Row3 points_m(int offset) const {
    const int at = reach_px + offset;
    return {x_.data() + at, y_.data() + at, z_.data() + at};
  }

 private:
  std::vector<float> range_m_;
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<float> z_;
};

/// Both ends of the tangent through every pixel of a row.
struct Tangents {
  const float* range_from_m;
  const float* range_to_m;
  Row3 from_m;
  Row3 to_m;
};

/// Ends that differ more in range are not on one surface.
[[gnu::always_inline]] inline bool on_one_surface(float from_m, float to_m) {
  constexpr float largest_step = 0.15F;  // of the range
  return std::abs(to_m - from_m) < largest_step * from_m;
}

/// g = n / (n · u) of the surface in every pixel of a row; NaN where its surroundings are not
/// smooth.
TOFMAP_VECTOR_CLONES void fill_gradients(int cols, const float* range_m, const Row3& rays_,
                                         const Tangents& across_, const Tangents& along_,
                                         float* gradient_x, float* gradient_y, float* gradient_z) {
  constexpr float steepest = 0.1F;  // cosine of incidence
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  const Row3 rays = rays_;
  const Tangents across = across_;
  const Tangents along = along_;
#pragma GCC ivdep
  for (int i = 0; i < cols; ++i) {
    const float ax = across.to_m.x[i] - across.from_m.x[i];
    const float ay = across.to_m.y[i] - across.from_m.y[i];
    const float az = across.to_m.z[i] - across.from_m.z[i];
    const float bx = along.to_m.x[i] - along.from_m.x[i];
    const float by = along.to_m.y[i] - along.from_m.y[i];
    const float bz = along.to_m.z[i] - along.from_m.z[i];
    const float nx = ay * bz - az * by;
    const float ny = az * bx - ax * bz;
    const float nz = ax * by - ay * bx;
    const float toward = nx * rays.x[i] + ny * rays.y[i] + nz * rays.z[i];
    const bool is_smooth = on_one_surface(across.range_from_m[i], across.range_to_m[i]) &&
                           on_one_surface(along.range_from_m[i], along.range_to_m[i]);
    const bool is_seen = toward * toward > steepest * steepest * (nx * nx + ny * ny + nz * nz);
    // A sum, unlike a choice, leaves the compiler no branch.
    const float absent = (is_smooth && is_seen ? 0.0F : nan) + 0 * range_m[i];
    const float scale = 1 / toward;
    gradient_x[i] = nx * scale + absent;
    gradient_y[i] = ny * scale + absent;
    gradient_z[i] = nz * scale + absent;
  }
}

/// The gradients of one row of pixels at a time.
class GradientRow {
 public:
  GradientRow(const ImageF& range_m, const PixelRays& rays)
      : range_m_(range_m),
        rays_(rays),
        above_(range_m.cols()),
        here_(range_m.cols()),
        below_(range_m.cols()) {
    for (std::vector<float>* plane : {&x, &y, &z}) {
      plane->resize(static_cast<std::size_t>(range_m.cols()));
    }
  }

  void assign(Eigen::Index row) {
    above_.assign(range_m_, rays_, std::max<Eigen::Index>(row - reach_px, 0));
    here_.assign(range_m_, rays_, row);
    below_.assign(range_m_, rays_, std::min(row + reach_px, range_m_.rows() - 1));
    const Eigen::Index place = row * range_m_.cols();
    fill_gradients(static_cast<int>(range_m_.cols()), here_.range_m(0),
                   {rays_.x.data() + place, rays_.y.data() + place, rays_.z.data() + place},
                   {here_.range_m(-reach_px), here_.range_m(reach_px), here_.points_m(-reach_px),
                    here_.points_m(reach_px)},
                   {above_.range_m(0), below_.range_m(0), above_.points_m(0), below_.points_m(0)},
                   x.data(), y.data(), z.data());
  }

  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;

 private:
  const ImageF& range_m_;
  const PixelRays& rays_;
  PointRow above_;
  PointRow here_;
  PointRow below_;
};

/// Equations for the motion, one a pixel, number by number.
struct Observations {
  std::array<std::vector<float>, 6> jacobian;
  std::vector<float> residual_m;
  std::vector<float> weight;

  std::size_t size() const { return weight.size(); }

  void append(const std::array<float, 6>& row, float residual, float its_weight) {
    for (std::size_t k = 0; k < row.size(); ++k) jacobian[k].push_back(row[k]);
    residual_m.push_back(residual);
    weight.push_back(its_weight);
  }
};

Observations observe(const ImageF& range_m, const ImageF& residual_m, const ImageF& sigma_m,
                     const PixelRays& rays) {
  constexpr Eigen::Index enough = 4000;
  constexpr float least_sigma_m = 0.01F;  // what calibration leaves
  const auto step = static_cast<Eigen::Index>(
      std::sqrt(std::max(1.0, static_cast<double>(range_m.size()) / enough)));
  Observations observations;
  GradientRow gradient(range_m, rays);
  for (Eigen::Index v = 0; v < range_m.rows(); v += step) {
    gradient.assign(v);
    for (Eigen::Index u = 0; u < range_m.cols(); u += step) {
      const auto at = static_cast<std::size_t>(u);
      if (!std::isfinite(residual_m(v, u)) || std::isnan(gradient.x[at])) continue;
      const Eigen::Vector3f g(gradient.x[at], gradient.y[at], gradient.z[at]);
      const Eigen::Vector3f turned =
          (range_m(v, u) * Eigen::Vector3f(rays.x(v, u), rays.y(v, u), rays.z(v, u))).cross(g);
      const float variance_m2 = sigma_m(v, u) * sigma_m(v, u) + least_sigma_m * least_sigma_m;
      observations.append({g.x(), g.y(), g.z(), turned.x(), turned.y(), turned.z()},
                          residual_m(v, u), 1 / variance_m2);
    }
  }
  return observations;
}

/// Equations summed at a time, one in each lane.
constexpr int lanes = DiagonalLayout::lanes;

/// Sums of one lane each: the lower triangle of the information row by row, then the gradient.
using LaneSums = std::array<std::array<float, lanes>, 27>;

[[gnu::always_inline]] inline void add_products(const float* a, const float* b, float* sums) {
#pragma GCC ivdep
  for (int i = 0; i < lanes; ++i) sums[i] += a[i] * b[i];
}

/// Adds `lanes` equations, from the first on, with Huber's weights at a motion.
TOFMAP_VECTOR_CLONES void add_equations(const std::array<const float*, 6>& jacobian,
                                        const float* residual_m, const float* weight,
                                        const std::array<float, 6>& twist, LaneSums& sums) {
  constexpr float limit = 1.5F;  // standard deviations
  const auto [j0, j1, j2, j3, j4, j5] = jacobian;
  const auto [t0, t1, t2, t3, t4, t5] = twist;
  std::array<float, lanes> robust;
#pragma GCC ivdep
  for (int i = 0; i < lanes; ++i) {
    const float off_m =
        residual_m[i] - j0[i] * t0 - j1[i] * t1 - j2[i] * t2 - j3[i] * t3 - j4[i] * t4 - j5[i] * t5;
    const float deviations = std::abs(off_m) * std::sqrt(weight[i]);
    const float larger = deviations > limit ? deviations : limit;
    robust[static_cast<std::size_t>(i)] = weight[i] * (limit / larger);
  }
  std::size_t sum = 0;
  std::array<std::array<float, lanes>, 6> weighted;
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t i = 0; i < lanes; ++i) weighted[a][i] = robust[i] * jacobian[a][i];
    for (std::size_t b = 0; b <= a; ++b) {
      add_products(weighted[a].data(), jacobian[b], sums[sum++].data());
    }
  }
  for (std::size_t a = 0; a < 6; ++a) {
    add_products(weighted[a].data(), residual_m, sums[sum++].data());
  }
}

/// One step of iteratively reweighted least squares. `observations` fill whole vectors.
Vector6d improved(const Observations& observations, const Vector6d& twist) {
  std::array<float, 6> twist_f{};
  for (int k = 0; k < 6; ++k) twist_f[static_cast<std::size_t>(k)] = static_cast<float>(twist[k]);
  LaneSums sums{};
  for (std::size_t i = 0; i < observations.size(); i += lanes) {
    std::array<const float*, 6> jacobian{};
    for (std::size_t k = 0; k < 6; ++k) jacobian[k] = observations.jacobian[k].data() + i;
    add_equations(jacobian, observations.residual_m.data() + i, observations.weight.data() + i,
                  twist_f, sums);
  }
  const auto total = [&](std::size_t sum) {
    double of_lanes = 0;
    for (const float lane : sums[sum]) of_lanes += lane;
    return of_lanes;
  };
  // Without surfaces that tell them apart, directions stay near zero: 10 cm and 0.1 rad are large.
  Matrix6d information = Matrix6d::Identity() / (0.1 * 0.1);
  Vector6d gradient;
  std::size_t sum = 0;
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b <= a; ++b) information(a, b) += total(sum++);
  }
  for (int a = 0; a < 6; ++a) gradient[a] = total(sum++);
  return information.selfadjointView<Eigen::Lower>().ldlt().solve(gradient);
}

/// g · (t + ω × p) for every pixel of a row; where the gradient is unknown, the surface faces the
/// camera. 0 without a range.
TOFMAP_VECTOR_CLONES void fill_shrinkage(int cols, const float* range_m, const Row3& rays_,
                                         const Row3& gradient_, const std::array<float, 6>& twist_,
                                         float* shrinkage_m) {
  const Row3 rays = rays_;
  const Row3 gradient = gradient_;
  const auto [tx, ty, tz, wx, wy, wz] = twist_;
#pragma GCC ivdep
  for (int i = 0; i < cols; ++i) {
    const bool is_known = gradient.x[i] == gradient.x[i];
    const float gx = is_known ? gradient.x[i] : rays.x[i];
    const float gy = is_known ? gradient.y[i] : rays.y[i];
    const float gz = is_known ? gradient.z[i] : rays.z[i];
    const float x = range_m[i] * rays.x[i];
    const float y = range_m[i] * rays.y[i];
    const float z = range_m[i] * rays.z[i];
    const float shrinkage =
        gx * (tx + wy * z - wz * y) + gy * (ty + wz * x - wx * z) + gz * (tz + wx * y - wy * x);
    shrinkage_m[i] = shrinkage == shrinkage ? shrinkage : 0.0F;
  }
}

}  // namespace

ExposureMotion estimate_exposure_motion(const ImageF& range_m, const ImageF& residual_m,
                                        const ImageF& sigma_m, const PixelRays& rays) {
  constexpr std::size_t enough = 200;
  constexpr int rounds = 4;
  Observations observations = observe(range_m, residual_m, sigma_m, rays);
  ExposureMotion motion;
  if (observations.size() < enough) return motion;
  motion.pixels = static_cast<int>(observations.size());
  while (observations.size() % lanes != 0) observations.append({}, 0, 0);
  Vector6d twist = Vector6d::Zero();
  for (int round = 0; round < rounds; ++round) twist = improved(observations, twist);
  motion.translation_m = twist.head<3>().cast<float>();
  motion.rotation_rad = twist.tail<3>().cast<float>();
  return motion;
}

ImageF range_shrinkage_m(const ExposureMotion& motion, const ImageF& range_m,
                         const PixelRays& rays) {
  ImageF shrinkage_m(range_m.rows(), range_m.cols());
  std::array<float, 6> twist{};
  for (int k = 0; k < 3; ++k) {
    twist[static_cast<std::size_t>(k)] = motion.translation_m[k];
    twist[static_cast<std::size_t>(k + 3)] = motion.rotation_rad[k];
  }
  GradientRow gradient(range_m, rays);
  for (Eigen::Index v = 0; v < range_m.rows(); ++v) {
    gradient.assign(v);
    const Eigen::Index place = v * range_m.cols();
    fill_shrinkage(static_cast<int>(range_m.cols()), range_m.data() + place,
                   {rays.x.data() + place, rays.y.data() + place, rays.z.data() + place},
                   {gradient.x.data(), gradient.y.data(), gradient.z.data()}, twist,
                   shrinkage_m.data() + place);
  }
  return shrinkage_m;
}

}  // namespace tofmap
