// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/residual_samples.hpp"

#include "common/fast_math.hpp"
#include "errors/surface_slopes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

namespace tofmap {
namespace {

/// Distance of the neighbours that show whether a surface bends. Slopes are fitted to at least this
/// neighbourhood.
constexpr Eigen::Index bend_reach_px = 2;
constexpr int widest_reach_px = 3;

/// Differences of noisier phases wrap too often for their mean to be right.
constexpr float loudest_cycles = 0.15F;

/// Largest noise of a sample, as a share of the residual step, at which its wrap count is certain.
constexpr float largest_share = 0.2F;

/// Windows grow until the noise is below this share of the residual step, since samples with less
/// noise are more informative.
constexpr float wanted_share = 0.07F;

/// The mean phase of the pixels with a return in a window, cycles, and the number of these pixels.
struct WindowMean {
  float phase;
  float pixels;
};

WindowMean window_mean(const ImageF& phase, Eigen::Index row, Eigen::Index col,
                       Eigen::Index reach) {
  const float middle = phase(row, col);
  if (reach == 0) return {middle, 1};
  float sum = 0;
  float pixels = 0;
  const Eigen::Index last_row = std::min(phase.rows() - 1, row + reach);
  const Eigen::Index last_col = std::min(phase.cols() - 1, col + reach);
  for (Eigen::Index v = std::max<Eigen::Index>(0, row - reach); v <= last_row; ++v) {
    for (Eigen::Index u = std::max<Eigen::Index>(0, col - reach); u <= last_col; ++u) {
      if (std::isnan(phase(v, u))) continue;
      sum += to_half_cycle(phase(v, u) - middle);
      pixels += 1;
    }
  }
  const float mean = middle + sum / pixels;
  return {mean - std::floor(mean), pixels};
}

/// Whether A's surface neither bends nor ends at a pixel.
bool is_smooth(const ExposurePair& pair, Eigen::Index v, Eigen::Index u, float wavelength_m) {
  const ImageF& phase = pair.phase_a;
  const float here = phase(v, u);
  const float before = phase(v, u - bend_reach_px);
  const float after = phase(v, u + bend_reach_px);
  const float over = phase(v - bend_reach_px, u);
  const float under = phase(v + bend_reach_px, u);
  if (std::isnan(before + after + over + under)) return false;
  const float sigma_m = pair.sigma_a_cycles(v, u) * wavelength_m;
  const float tolerated = tolerated_bend(sigma_m) / wavelength_m;
  return is_straight(to_half_cycle(here - before), to_half_cycle(after - here), tolerated) &&
         is_straight(to_half_cycle(here - over), to_half_cycle(under - here), tolerated);
}

/// The slope of A's range per column and per row, metres per pixel. It is fitted to pairs of pixels
/// on opposite sides of the pixel, up to `reach` away, whose phases lie on one line with the
/// pixel's. Returns zero if noise dominates the slope: a noisy slope would make motion look smaller
/// than it is.
Eigen::Vector2f slope_m(const ExposurePair& pair, Eigen::Index v, Eigen::Index u,
                        Eigen::Index reach, float wavelength_m) {
  constexpr float loud_m = 0.035F;
  const ImageF& phase = pair.phase_a;
  const float middle = phase(v, u);
  const float sigma_m = pair.sigma_a_cycles(v, u) * wavelength_m;
  const float tolerated = tolerated_bend(sigma_m) / wavelength_m;
  Eigen::Vector2f moment = Eigen::Vector2f::Zero();
  Eigen::Vector2f square = Eigen::Vector2f::Zero();
  for (Eigen::Index dv = 0; dv <= reach; ++dv) {
    for (Eigen::Index du = dv == 0 ? 1 : -reach; du <= reach; ++du) {
      const float ahead = to_half_cycle(phase(v + dv, u + du) - middle);
      const float behind = to_half_cycle(phase(v - dv, u - du) - middle);
      if (std::isnan(ahead + behind) || !is_straight(-behind, ahead, tolerated)) continue;
      const Eigen::Vector2f offset(static_cast<float>(du), static_cast<float>(dv));
      moment += offset * (ahead - behind);
      square += 2 * offset.cwiseProduct(offset);
    }
  }
  if (!(sigma_m * sigma_m < loud_m * loud_m * square.minCoeff())) return Eigen::Vector2f::Zero();
  return wavelength_m * moment.cwiseQuotient(square);
}

/// The reach of the window that noise of this standard deviation needs, in pixels. Empty if even
/// the largest window leaves too much noise.
std::optional<int> window_reach(float sigma_m, double residual_step_m) {
  const auto step_m = static_cast<float>(residual_step_m);
  int reach = 0;
  const auto share = [&] { return sigma_m / static_cast<float>(2 * reach + 1) / step_m; };
  while (reach < widest_reach_px && share() > wanted_share) ++reach;
  if (share() > largest_share) return std::nullopt;
  return reach;
}

/// Appends ray, slope and gradient of a sample.
void append_ray(const PixelRays& rays, Eigen::Index v, Eigen::Index u, const Eigen::Vector2f& slope,
                SurfaceSamples& samples) {
  const auto ray = [&](Eigen::Index row, Eigen::Index col) {
    return Eigen::Vector3f(rays.x(row, col), rays.y(row, col), rays.z(row, col));
  };
  const Eigen::Vector3f here = ray(v, u);
  const Eigen::Vector3f across =
      (ray(v, u + bend_reach_px) - ray(v, u - bend_reach_px)) / (2 * bend_reach_px);
  const Eigen::Vector3f along =
      (ray(v + bend_reach_px, u) - ray(v - bend_reach_px, u)) / (2 * bend_reach_px);
  const Eigen::Vector3f gradient =
      (slope.x() * along.cross(here) + slope.y() * here.cross(across)) /
      across.cross(along).dot(here);
  samples.ray_x.push_back(here.x());
  samples.ray_y.push_back(here.y());
  samples.ray_z.push_back(here.z());
  samples.slope_x.push_back(slope.x());
  samples.slope_y.push_back(slope.y());
  samples.gradient_x.push_back(gradient.x());
  samples.gradient_y.push_back(gradient.y());
  samples.gradient_z.push_back(gradient.z());
}

/// Appends the sample at a pixel, unless the pixel is too noisy or its surface is not smooth.
void append_sample(const ExposurePair& pair, const PairGeometry& geometry, double residual_step_m,
                   Eigen::Index v, Eigen::Index u, SurfaceSamples& samples) {
  const auto wavelength_a_m = static_cast<float>(geometry.limits.wavelength_a_m);
  const auto wavelength_b_m = static_cast<float>(geometry.limits.wavelength_b_m);
  const float sigma_a = pair.sigma_a_cycles(v, u);
  const float sigma_b = pair.sigma_b_cycles(v, u);
  if (!(sigma_a < loudest_cycles && sigma_b < loudest_cycles)) return;
  const auto reach =
      window_reach(std::hypot(sigma_a * wavelength_a_m, sigma_b * wavelength_b_m), residual_step_m);
  if (!reach || !is_smooth(pair, v, u, wavelength_a_m)) return;
  const WindowMean mean = window_mean(pair.phase_a, v, u, *reach);
  const auto side = static_cast<float>(2 * *reach + 1);
  if (mean.pixels < side * side) return;
  const float sigma_m = sigma_a * wavelength_a_m / std::sqrt(mean.pixels);
  samples.row.push_back(static_cast<int>(v));
  samples.col.push_back(static_cast<int>(u));
  samples.reach_px.push_back(*reach);
  samples.phase_a.push_back(mean.phase);
  samples.variance_a_m2.push_back(sigma_m * sigma_m);
  if (pair.has_amplitude()) samples.amplitude_a.push_back(pair.amplitude_a(v, u));
  if (!geometry.knows_camera()) return;
  const Eigen::Index slope_reach = std::max<Eigen::Index>(*reach, bend_reach_px);
  append_ray(geometry.rays, v, u, slope_m(pair, v, u, slope_reach, wavelength_a_m), samples);
}

constexpr Eigen::Index nowhere = -1;

/// Fills in what B measured of sample i in the window around pixel (v, u), whose index is `place`.
void see(const SurfaceSamples& samples, std::size_t i, Eigen::Index v, Eigen::Index u,
         Eigen::Index place, const ExposurePair& pair, const PairGeometry& geometry,
         SeenSamples& seen) {
  seen.place[i] = place;
  seen.phase_b[i] = nan;
  if (place == nowhere || std::isnan(pair.phase_b(v, u))) return;
  const WindowMean mean = window_mean(pair.phase_b, v, u, samples.reach_px[i]);
  const float sigma_m =
      pair.sigma_b_cycles(v, u) * static_cast<float>(geometry.limits.wavelength_b_m);
  seen.phase_b[i] = mean.phase;
  seen.variance_m2[i] = samples.variance_a_m2[i] + sigma_m * sigma_m / mean.pixels;
  if (pair.has_amplitude()) {
    seen.amplitude_ratio[i] = pair.amplitude_b(v, u) / samples.amplitude_a[i];
  }
}

}  // namespace

SurfaceSamples gather_samples(const ExposurePair& pair, const PairGeometry& geometry,
                              double residual_step_m) {
  constexpr double enough = 1500;
  const Eigen::Index rows = pair.phase_a.rows();
  const Eigen::Index cols = pair.phase_a.cols();
  const auto stride = static_cast<Eigen::Index>(
      std::max(1.0, std::round(std::sqrt(static_cast<double>(rows * cols) / enough))));
  constexpr Eigen::Index margin = std::max<Eigen::Index>(bend_reach_px, widest_reach_px);
  const Eigen::Index first = std::max(margin, stride / 2);
  SurfaceSamples samples;
  for (Eigen::Index v = first; v + margin < rows; v += stride) {
    for (Eigen::Index u = first; u + margin < cols; u += stride) {
      if (std::isnan(pair.phase_a(v, u))) continue;
      append_sample(pair, geometry, residual_step_m, v, u, samples);
    }
  }
  return samples;
}

void look_up_samples(const SurfaceSamples& samples, const std::vector<float>& range_m,
                     const ExposurePair& pair, const PairGeometry& geometry,
                     const ExposureMotion& motion, SeenSamples& seen) {
  const std::size_t size = samples.size();
  std::vector<float> col(size);
  std::vector<float> row(size);
  if (seen.place.size() != size) {
    seen = {std::vector<Eigen::Index>(size, nowhere), std::vector<float>(size, nan),
            samples.variance_a_m2, std::vector<float>(size, 0.0F),
            std::vector<float>(pair.has_amplitude() ? size : 0, 1.0F)};
  }
  std::ranges::fill(seen.shift_m, 0.0F);
  if (geometry.knows_camera()) {
    warp(ExposureWarp(geometry.camera, motion), static_cast<int>(size), samples.ray_x.data(),
         samples.ray_y.data(), samples.ray_z.data(), range_m.data(), col.data(), row.data(),
         seen.shift_m.data());
  } else {
    std::copy(samples.col.begin(), samples.col.end(), col.begin());
    std::copy(samples.row.begin(), samples.row.end(), row.begin());
  }
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_inside = col[i] > -0.5F && row[i] > -0.5F &&
                           col[i] < static_cast<float>(pair.phase_b.cols()) - 0.5F &&
                           row[i] < static_cast<float>(pair.phase_b.rows()) - 0.5F;
    const auto u = static_cast<Eigen::Index>(is_inside ? col[i] + 0.5F : 0.0F);
    const auto v = static_cast<Eigen::Index>(is_inside ? row[i] + 0.5F : 0.0F);
    const Eigen::Index place = is_inside ? v * pair.phase_b.cols() + u : nowhere;
    if (place != seen.place[i]) see(samples, i, v, u, place, pair, geometry, seen);
    if (is_inside && geometry.knows_camera()) {
      seen.shift_m[i] += samples.slope_x[i] * (col[i] - static_cast<float>(u)) +
                         samples.slope_y[i] * (row[i] - static_cast<float>(v));
    }
  }
}

}  // namespace tofmap
