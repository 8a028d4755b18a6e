// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "peers/synthetic_scenes.hpp"

#include "peers/phase_noise.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Core>

namespace tofmap::peers {
namespace {

using Eigen::Vector3d;

/// A box, or a room seen from within.
struct Box {
  Vector3d low;
  Vector3d high;
};

/// x to the right, y down, z forward, with the camera at the origin.
std::vector<Box> boxes_of(SyntheticScene scene) {
  switch (scene) {
    case SyntheticScene::office:
      return {{{-3, -1.3, -0.5}, {3, 1.4, 4.5}},
              {{-2.4, 0.7, 2.2}, {-0.8, 1.4, 3.1}},
              {{0.5, 0.2, 1.6}, {1.2, 1.4, 2.1}},
              {{1.8, -0.7, 3.4}, {2.9, 1.4, 4.2}},
              {{-0.5, -0.1, 3.6}, {0.3, 0.6, 3.8}}};
    case SyntheticScene::hall:
      return {{{-6, -5, -1}, {6, 2, 16}},     {{-3.5, -5, 5}, {-3, 2, 5.5}},
              {{3, -5, 5}, {3.5, 2, 5.5}},    {{-3.5, -5, 10}, {-3, 2, 10.5}},
              {{3, -5, 10}, {3.5, 2, 10.5}},  {{-1.5, 0.8, 2.2}, {-0.6, 2, 2.8}},
              {{0.4, 0.9, 6.5}, {1.8, 2, 8}}, {{-0.3, -1, 12}, {0.4, 2, 12.3}}};
    case SyntheticScene::corridor:
      return {{{-1.5, -1.3, -0.5}, {1.5, 1.4, 17.3}},
              {{-1.5, -1.3, 6}, {-1.2, 1.4, 7}},
              {{1.1, 0.3, 9}, {1.5, 1.4, 11}},
              {{-0.4, 0.4, 13}, {0.2, 1.4, 13.4}}};
  }
  return {};
}

struct Hit {
  double range_m = std::numeric_limits<double>::infinity();
  double albedo = 0;
};

/// Chequered with squares of 0.5 m. Each side of each box has its own brightness.
double albedo_at(const Vector3d& point, int box, int side) {
  const Eigen::Vector3i cell = (point * 2).array().floor().cast<int>();
  const bool bright = (cell.x() + cell.y() + cell.z()) % 2 == 0;
  const double level = 0.35 + 0.09 * ((box * 7 + side * 5) % 6);
  return bright ? level : level - 0.15;
}

/// The first side of the box that the ray meets, from outside or from within.
void intersect(const Box& box, int index, const Vector3d& direction, Hit& nearest) {
  double entry = -std::numeric_limits<double>::infinity();
  double leaving = std::numeric_limits<double>::infinity();
  int entry_side = 0;
  int leaving_side = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / direction[axis];
    const double near = std::min(box.low[axis] * inverse, box.high[axis] * inverse);
    const double far = std::max(box.low[axis] * inverse, box.high[axis] * inverse);
    if (near > entry) {
      entry = near;
      entry_side = axis;
    }
    if (far < leaving) {
      leaving = far;
      leaving_side = axis;
    }
  }
  if (entry >= leaving || leaving <= 0) return;
  const bool from_within = entry <= 0;
  const double range = from_within ? leaving : entry;
  if (range >= nearest.range_m) return;
  const int side = from_within ? leaving_side : entry_side;
  // The point is moved off the side, so that rounding does not choose its square.
  Vector3d point = range * direction;
  point[side] += 0.01;
  nearest = {range, albedo_at(point, index, side)};
}

}  // namespace

std::string_view name_of(SyntheticScene scene) {
  switch (scene) {
    case SyntheticScene::office:
      return "office";
    case SyntheticScene::hall:
      return "hall";
    case SyntheticScene::corridor:
      return "corridor";
  }
  return {};
}

SceneView view_of(SyntheticScene scene, int width_px, int height_px) {
  const std::vector<Box> boxes = boxes_of(scene);
  const double focal_px = 0.71 * width_px;
  SceneView view{ImageF(height_px, width_px), ImageF(height_px, width_px)};
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      // Slightly turned, so that no ray is parallel to a side.
      const Vector3d direction = Vector3d((u + 0.5 - width_px / 2.0) / focal_px + 0.0137,
                                          (v + 0.5 - height_px / 2.0) / focal_px + 0.0071, 1)
                                     .normalized();
      Hit hit;
      for (int b = 0; b < static_cast<int>(boxes.size()); ++b)
        intersect(boxes[static_cast<std::size_t>(b)], b, direction, hit);
      view.range_m(v, u) = static_cast<float>(hit.range_m);
      view.albedo(v, u) = static_cast<float>(hit.albedo);
    }
  }
  return view;
}

ThreePhases measure(const SceneView& view, const NoiseOptions& options) {
  constexpr double speed_of_light_m_s = 299792458;
  const double noise = options.sigma_at_10_m_rad;
  // σ of the noise is 1 / γ₀ in both components, whatever the amplitude.
  const double amplitude_at_10_m = noise > 0 ? 1 / (kinect_v2_noise[0].gamma_0 * noise) : 30;
  std::mt19937 random(options.seed);
  std::normal_distribution<double> normal;
  ThreePhases out;
  for (std::size_t m = 0; m < 3; ++m) {
    const double wavelength_m = speed_of_light_m_s / (2 * out.frequencies_hz[m]);
    const double sigma = noise > 0 ? 1 / kinect_v2_noise[m].gamma_0 : 0;
    out.phase_cycles[m].resizeLike(view.range_m);
    out.amplitude[m].resizeLike(view.range_m);
    for (Eigen::Index i = 0; i < view.range_m.size(); ++i) {
      const double range_m = view.range_m.data()[i] + options.range_bias_m[m];
      const double amplitude =
          amplitude_at_10_m * 200 * view.albedo.data()[i] / (range_m * range_m);
      const std::complex<double> phasor =
          std::polar(amplitude, 2 * std::numbers::pi * range_m / wavelength_m) +
          sigma * std::complex<double>(normal(random), normal(random));
      const double cycles = std::arg(phasor) / (2 * std::numbers::pi);
      const auto phase = static_cast<float>(cycles - std::floor(cycles));
      out.phase_cycles[m].data()[i] = phase >= 1 ? 0.0F : phase;
      out.amplitude[m].data()[i] = static_cast<float>(std::abs(phasor));
    }
  }
  return out;
}

}  // namespace tofmap::peers
