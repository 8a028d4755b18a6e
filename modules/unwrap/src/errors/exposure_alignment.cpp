// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/exposure_alignment.hpp"

#include "errors/exposure_pair.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// One pyramid level of both amplitude images: logarithms of the means over square blocks; NaN
/// where a block is dark.
struct Level {
  Level(const ImageF& amplitude_a, const ImageF& amplitude_b, Eigen::Index size_px)
      : block_px(size_px), a(blocks(amplitude_a)), b(blocks(amplitude_b)) {}

  Eigen::Index block_px;
  ImageF a;
  ImageF b;

 private:
  ImageF blocks(const ImageF& amplitude) const {
    ImageF out(amplitude.rows() / block_px, amplitude.cols() / block_px);
    for (Eigen::Index r = 0; r < out.rows(); ++r) {
      for (Eigen::Index c = 0; c < out.cols(); ++c) {
        const float mean = amplitude.block(r * block_px, c * block_px, block_px, block_px).mean();
        out(r, c) = mean > 0 ? std::log(mean) : nan;
      }
    }
    return out;
  }
};

/// The unknowns of the alignment.
struct Alignment {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< a_from_b
  double gain = 0;                                         ///< B's logarithms minus A's
};

/// The normal equations of one Gauss-Newton step, for rotation and gain.
struct Problem {
  /// Width of the robust kernel, in units of the natural logarithm of an amplitude.
  static constexpr double tolerated = 0.2;

  Eigen::Matrix4d information = Eigen::Matrix4d::Identity();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  /// The information about the rotation that image gradients of pure noise, with unit variance,
  /// would contribute.
  Eigen::Matrix3d of_noise = Eigen::Matrix3d::Zero();
  double weighted_squares = 0;  ///< weighted sum of squared errors
  double weights = 0;           ///< sum of the weights
  double disagreement = 1;      ///< mean robust cost before the step, 0 … 1
};

/// An image and its derivatives along columns and rows at one position, interpolated bilinearly.
struct Sampled {
  double value;
  double across;
  double along;
};

/// Empty outside the image and beside dark blocks.
std::optional<Sampled> sample(const ImageF& image, double col, double row) {
  const auto c = static_cast<Eigen::Index>(std::floor(col));
  const auto r = static_cast<Eigen::Index>(std::floor(row));
  if (c < 0 || r < 0 || c + 1 >= image.cols() || r + 1 >= image.rows()) return std::nullopt;
  const double right = col - static_cast<double>(c);
  const double down = row - static_cast<double>(r);
  const double upper = image(r, c) + right * (image(r, c + 1) - image(r, c));
  const double lower = image(r + 1, c) + right * (image(r + 1, c + 1) - image(r + 1, c));
  const Sampled sampled{
      upper + down * (lower - upper),
      (1 - down) * (image(r, c + 1) - image(r, c)) + down * (image(r + 1, c + 1) - image(r + 1, c)),
      lower - upper};
  return std::isnan(sampled.value) ? std::nullopt : std::optional(sampled);
}

/// Compares both images at an alignment. Lens distortion is ignored.
Problem compare(const Level& level, const CameraModel& camera, const Alignment& alignment) {
  constexpr double tolerated = Problem::tolerated;
  const auto block = static_cast<double>(level.block_px);
  const double half = (block - 1) / 2;
  Problem problem;
  double sum = 0;
  int blocks = 0;
  for (Eigen::Index r = 0; r < level.a.rows(); ++r) {
    for (Eigen::Index c = 0; c < level.a.cols(); ++c) {
      if (std::isnan(level.a(r, c))) continue;
      const double u = static_cast<double>(c) * block + half;
      const double v = static_cast<double>(r) * block + half;
      const Eigen::Vector3d ray((u - camera.cx_px) / camera.fx_px,
                                (v - camera.cy_px) / camera.fy_px, 1);
      const Eigen::Vector3d seen = alignment.rotation.transpose() * ray;
      const double x = seen.x() / seen.z();
      const double y = seen.y() / seen.z();
      const auto b = sample(level.b, (camera.fx_px * x + camera.cx_px - half) / block,
                            (camera.fy_px * y + camera.cy_px - half) / block);
      if (!b) continue;
      const double error = b->value - level.a(r, c) - alignment.gain;
      const double share = 1 / (1 + error * error / (tolerated * tolerated));
      sum += 1 - share;
      ++blocks;
      // If the camera rotates by ω, a ray p moves to p − ω × p.
      const Eigen::Vector3d by_col = camera.fx_px / block * Eigen::Vector3d(x * y, -(1 + x * x), y);
      const Eigen::Vector3d by_row = camera.fy_px / block * Eigen::Vector3d(1 + y * y, -x * y, -x);
      Eigen::Vector4d row;
      row << b->across * by_col + b->along * by_row, -1;
      problem.of_noise +=
          share * share * (by_col * by_col.transpose() + by_row * by_row.transpose());
      problem.information += share * share * row * row.transpose();
      problem.gradient += share * share * error * row;
      problem.weighted_squares += share * share * error * error;
      problem.weights += share * share;
    }
  }
  if (blocks > 0) problem.disagreement = sum / blocks;
  return problem;
}

/// Median of B's logarithms minus A's; NaN if all blocks are dark.
double median_gain(const Level& level) {
  std::vector<float> gains;
  for (Eigen::Index i = 0; i < level.a.size(); ++i) {
    const float gain = level.b.data()[i] - level.a.data()[i];
    if (!std::isnan(gain)) gains.push_back(gain);
  }
  return gains.empty() ? nan : double{median(gains)};
}

/// Tries rotations about the x and y axes that shift the image by up to two blocks, and keeps the
/// best one.
void search(const Level& level, const CameraModel& camera, Alignment& alignment) {
  constexpr int reach = 2;  // blocks
  constexpr double clearly_better = 0.97;
  const auto block = static_cast<double>(level.block_px);
  double least = compare(level, camera, alignment).disagreement;
  Alignment tried = alignment;
  for (int i = -reach; i <= reach; ++i) {
    for (int j = -reach; j <= reach; ++j) {
      tried.rotation = rotation_matrix({i * block / camera.fy_px, j * block / camera.fx_px, 0});
      const double disagreement = compare(level, camera, tried).disagreement;
      if (disagreement >= clearly_better * least) continue;
      least = disagreement;
      alignment.rotation = tried.rotation;
    }
  }
}

/// Refines rotation and gain by robust least squares.
void descend(const Level& level, const CameraModel& camera, Alignment& alignment) {
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    const Problem problem = compare(level, camera, alignment);
    const Eigen::Vector4d change = problem.information.ldlt().solve(-problem.gradient);
    alignment.rotation = alignment.rotation * rotation_matrix(change.head<3>());
    alignment.gain += change[3];
  }
}

/// Covariance of the rotation, with the gain marginalised out. Information that image gradients of
/// pure noise would contribute is subtracted.
Eigen::Matrix3d covariance_of(const Problem& problem) {
  // The errors of neighbouring blocks are correlated by their texture and by parallax.
  constexpr double correlated_blocks = 10;
  constexpr double least_sigma_rad = 0.003;
  constexpr double most_sigma_rad = 1;
  const double variance = problem.weighted_squares / std::max(problem.weights, 1.0);
  const Eigen::Vector3d with_gain = problem.information.topRightCorner<3, 1>();
  const Eigen::Matrix3d of_texture = problem.information.topLeftCorner<3, 3>() -
                                     with_gain * with_gain.transpose() / problem.information(3, 3) -
                                     variance * problem.of_noise;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(of_texture);
  const double most_variance = most_sigma_rad * most_sigma_rad;
  const double squares = correlated_blocks * std::max(variance, 1e-12);
  const Eigen::Vector3d along_axes =
      squares * axes.eigenvalues().cwiseMax(squares / most_variance).cwiseInverse();
  return axes.eigenvectors() * along_axes.asDiagonal() * axes.eigenvectors().transpose() +
         Eigen::Matrix3d::Identity() * least_sigma_rad * least_sigma_rad;
}

}  // namespace

std::optional<ApparentRotation> align_exposures(const ImageF& amplitude_a,
                                                const ImageF& amplitude_b,
                                                const CameraModel& camera) {
  // The coarse level has about 22 x 18 blocks, the fine level about twice as many in each
  // direction.
  constexpr Eigen::Index coarse_cols = 22;
  const Eigen::Index coarse_px = std::max<Eigen::Index>(2, amplitude_a.cols() / coarse_cols);
  if (amplitude_a.rows() < 4 * coarse_px || amplitude_a.cols() < 4 * coarse_px) {
    return std::nullopt;
  }
  const Level coarse(amplitude_a, amplitude_b, coarse_px);
  Alignment alignment;
  alignment.gain = median_gain(coarse);
  if (std::isnan(alignment.gain)) return std::nullopt;
  search(coarse, camera, alignment);
  descend(coarse, camera, alignment);
  const Level fine(amplitude_a, amplitude_b, std::max<Eigen::Index>(1, coarse_px / 2));
  descend(fine, camera, alignment);
  const Eigen::AngleAxisd rotation(alignment.rotation);
  const ApparentRotation out{rotation.angle() * rotation.axis(),
                             covariance_of(compare(fine, camera, alignment))};
  if (!out.rotation_rad.allFinite() || !out.covariance_rad2.allFinite()) return std::nullopt;
  return out;
}

}  // namespace tofmap
