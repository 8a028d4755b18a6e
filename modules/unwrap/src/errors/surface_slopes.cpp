// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/surface_slopes.hpp"

#include "common/fast_math.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <tofmap/core/vector_clones.hpp>

namespace tofmap {
namespace {

/// Distance of the neighbours that determine a slope.
constexpr Eigen::Index reach_px = 2;

/// With more noise than this, noise dominates a slope.
constexpr float loud_m = 0.1F;

/// The phases of a row's pixels and of their neighbours, cycles, and their noise.
struct Around {
  const float* here;
  const float* left;
  const float* right;
  const float* above;
  const float* below;
  const float* sigma_cycles;
};

TOFMAP_VECTOR_CLONES void fill_slopes(int cols, const Around& around_, float wavelength_m,
                                      float* across_m, float* along_m, float* rough_m) {
  const Around around = around_;
  constexpr float pixels = 2 * reach_px;
#pragma GCC ivdep
  for (int i = 0; i < cols; ++i) {
    const float here = around.here[i];
    const auto step = [](float difference) {
      return to_half_cycle(difference == difference ? difference : 0.5F);
    };
    const float left = step(here - around.left[i]);
    const float right = step(around.right[i] - here);
    const float above = step(here - around.above[i]);
    const float below = step(around.below[i] - here);
    const float sigma_m = around.sigma_cycles[i] * wavelength_m;
    const float tolerated = tolerated_bend(sigma_m) / wavelength_m;
    const float smooth = is_straight(left, right, tolerated) ? 1.0F : 0.0F;
    const float smooth_both = is_straight(above, below, tolerated) ? smooth : 0.0F;
    const float sloped = sigma_m < loud_m ? smooth_both : 0.0F;
    const float across = (left + right) * wavelength_m / pixels;
    const float along = (above + below) * wavelength_m / pixels;
    across_m[i] = sloped * across;
    along_m[i] = sloped * along;
    rough_m[i] = (1 - smooth_both) * std::sqrt(across * across + along * along);
  }
}

/// x, y and z of the rays of a row's pixels and of their neighbours.
struct RowOfRays {
  const float* here[3];
  const float* left[3];
  const float* right[3];
  const float* above[3];
  const float* below[3];
};

TOFMAP_VECTOR_CLONES void fill_gradients(int cols, const RowOfRays& rays_, const float* across_m,
                                         const float* along_m, float* gradient_x, float* gradient_y,
                                         float* gradient_z) {
  const RowOfRays rays = rays_;
  constexpr float pixels = 2 * reach_px;
#pragma GCC ivdep
  for (int i = 0; i < cols; ++i) {
    const float ux = rays.here[0][i];
    const float uy = rays.here[1][i];
    const float uz = rays.here[2][i];
    const float ax = (rays.right[0][i] - rays.left[0][i]) / pixels;
    const float ay = (rays.right[1][i] - rays.left[1][i]) / pixels;
    const float az = (rays.right[2][i] - rays.left[2][i]) / pixels;
    const float bx = (rays.below[0][i] - rays.above[0][i]) / pixels;
    const float by = (rays.below[1][i] - rays.above[1][i]) / pixels;
    const float bz = (rays.below[2][i] - rays.above[2][i]) / pixels;
    const float volume =
        (ay * bz - az * by) * ux + (az * bx - ax * bz) * uy + (ax * by - ay * bx) * uz;
    // In an image of a single row or column, rays do not change in the other direction.
    const float per_volume = volume > 0 ? 1 / volume : 0.0F;
    const float across = across_m[i] * per_volume;
    const float along = along_m[i] * per_volume;
    gradient_x[i] = across * (by * uz - bz * uy) + along * (uy * az - uz * ay);
    gradient_y[i] = across * (bz * ux - bx * uz) + along * (uz * ax - ux * az);
    gradient_z[i] = across * (bx * uy - by * ux) + along * (ux * ay - uy * ax);
  }
}

/// Copies a row of an image and repeats the border pixel twice on both sides.
void copy_padded(const ImageF& image, Eigen::Index row, float* to) {
  const Eigen::Index cols = image.cols();
  const float* from = image.data() + row * cols;
  std::fill_n(to, reach_px, from[0]);
  std::copy_n(from, cols, to + reach_px);
  std::fill_n(to + reach_px + cols, reach_px, from[cols - 1]);
}

}  // namespace

SurfaceSlopes::SurfaceSlopes(const ExposurePair& pair, const PairGeometry& geometry)
    : pair_(pair), geometry_(geometry) {
  const auto cols = static_cast<std::size_t>(pair.phase_a.cols());
  for (auto* plane : {&across_m, &along_m, &rough_m, &gradient_x, &gradient_y, &gradient_z}) {
    plane->assign(cols, 0.0F);
  }
  phase_.resize(cols + 2 * reach_px);
  rays_.resize(3 * phase_.size());
}

void SurfaceSlopes::find(Eigen::Index row) {
  const Eigen::Index cols = pair_.phase_a.cols();
  const Eigen::Index above = std::max<Eigen::Index>(row - reach_px, 0);
  const Eigen::Index below = std::min(row + reach_px, pair_.phase_a.rows() - 1);
  copy_padded(pair_.phase_a, row, phase_.data());
  const float* phases = pair_.phase_a.data();
  fill_slopes(
      static_cast<int>(cols),
      {phase_.data() + reach_px, phase_.data(), phase_.data() + 2 * reach_px, phases + above * cols,
       phases + below * cols, pair_.sigma_a_cycles.data() + row * cols},
      static_cast<float>(geometry_.limits.wavelength_a_m), across_m.data(), along_m.data(),
      rough_m.data());
}

void SurfaceSlopes::find_gradients(Eigen::Index row) {
  if (!geometry_.knows_camera()) return;
  const Eigen::Index cols = pair_.phase_a.cols();
  const Eigen::Index above = std::max<Eigen::Index>(row - reach_px, 0);
  const Eigen::Index below = std::min(row + reach_px, pair_.phase_a.rows() - 1);
  RowOfRays rays{};
  const std::array<const ImageF*, 3> planes{&geometry_.rays.x, &geometry_.rays.y,
                                            &geometry_.rays.z};
  for (std::size_t k = 0; k < 3; ++k) {
    float* padded = rays_.data() + k * phase_.size();
    copy_padded(*planes[k], row, padded);
    rays.here[k] = padded + reach_px;
    rays.left[k] = padded;
    rays.right[k] = padded + 2 * reach_px;
    rays.above[k] = planes[k]->data() + above * cols;
    rays.below[k] = planes[k]->data() + below * cols;
  }
  fill_gradients(static_cast<int>(cols), rays, across_m.data(), along_m.data(), gradient_x.data(),
                 gradient_y.data(), gradient_z.data());
}

}  // namespace tofmap
