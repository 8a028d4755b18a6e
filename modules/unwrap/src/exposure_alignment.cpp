// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "exposure_alignment.hpp"

#include "exposure_pair.hpp"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// Logarithms of both amplitudes, averaged over square blocks; NaN where nothing is lit.
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
        out(r, c) = mean > 0 ? std::log(mean) : std::numeric_limits<float>::quiet_NaN();
      }
    }
    return out;
  }
};

/// A rotation, and by how much B's logarithms are larger than A's.
struct Alignment {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double gain = 0;
};

/// The least-squares problem of one step, and how badly the images agree before it, 0 … 1.
struct Problem {
  Eigen::Matrix4d information = Eigen::Matrix4d::Identity();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  double disagreement = 1;
};

/// An image between its pixels, and its derivatives.
struct Sampled {
  double value;
  double across;
  double along;
};

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

Problem compare(const Level& level, const CameraModel& camera, const Alignment& alignment) {
  constexpr double tolerated = 0.2;  // of a logarithm
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
      // Turning by ω moves a ray p to p − ω × p.
      const double across = b->across * camera.fx_px / block;
      const double along = b->along * camera.fy_px / block;
      Eigen::Vector4d row;
      row << across * Eigen::Vector3d(x * y, -(1 + x * x), y) +
                 along * Eigen::Vector3d(1 + y * y, -x * y, -x),
          -1;
      problem.information += share * share * row * row.transpose();
      problem.gradient += share * share * error * row;
    }
  }
  if (blocks > 0) problem.disagreement = sum / blocks;
  return problem;
}

double median_gain(const Level& level) {
  std::vector<float> gains;
  for (Eigen::Index i = 0; i < level.a.size(); ++i) {
    const float gain = level.b.data()[i] - level.a.data()[i];
    if (!std::isnan(gain)) gains.push_back(gain);
  }
  return gains.empty() ? std::numeric_limits<double>::quiet_NaN() : double{median(gains)};
}

/// The best of some rotations about the axes of rows and columns.
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

void descend(const Level& level, const CameraModel& camera, Alignment& alignment) {
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    const Problem problem = compare(level, camera, alignment);
    const Eigen::Vector4d change = problem.information.ldlt().solve(-problem.gradient);
    alignment.rotation = alignment.rotation * rotation_matrix(change.head<3>());
    alignment.gain += change[3];
  }
}

}  // namespace

Eigen::Vector3d align_exposures(const ImageF& amplitude_a, const ImageF& amplitude_b,
                                const CameraModel& camera) {
  // Blocks that make an image of about 22 x 18, and of twice that.
  constexpr Eigen::Index coarse_cols = 22;
  const Eigen::Index coarse_px = std::max<Eigen::Index>(2, amplitude_a.cols() / coarse_cols);
  if (amplitude_a.rows() < 4 * coarse_px || amplitude_a.cols() < 4 * coarse_px) {
    return Eigen::Vector3d::Zero();
  }
  const Level coarse(amplitude_a, amplitude_b, coarse_px);
  Alignment alignment;
  alignment.gain = median_gain(coarse);
  if (std::isnan(alignment.gain)) return Eigen::Vector3d::Zero();
  search(coarse, camera, alignment);
  descend(coarse, camera, alignment);
  descend(Level(amplitude_a, amplitude_b, std::max<Eigen::Index>(1, coarse_px / 2)), camera,
          alignment);
  const Eigen::AngleAxisd rotation(alignment.rotation);
  return rotation.angle() * rotation.axis();
}

}  // namespace tofmap
