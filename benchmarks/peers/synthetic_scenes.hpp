// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/three_phases.hpp"

#include <array>
#include <string_view>

namespace tofmap::peers {

/// Rooms of axis-aligned boxes with chequered albedos of 0.2 to 0.8, seen by a camera whose focal
/// length is 0.71 times the image's width.
enum class SyntheticScene {
  office,    ///< 6 × 5 × 2.7 m with furniture, ranges 1.2 to 6 m
  hall,      ///< 12 × 17 × 7 m with pillars, ranges 2 to 18.3 m
  corridor,  ///< 3 × 2.7 m, 17.8 m long; nearly everything is seen at a grazing angle
};
inline constexpr std::array all_synthetic_scenes{SyntheticScene::office, SyntheticScene::hall,
                                                 SyntheticScene::corridor};

std::string_view name_of(SyntheticScene scene);

/// The radial range of every pixel, 0.5 to 18.4 m, and the albedo of what it sees.
struct SceneView {
  ImageF range_m;
  ImageF albedo;
};
SceneView view_of(SyntheticScene scene, int width_px, int height_px);

struct NoiseOptions {
  /// Standard deviation of the phase at 80 MHz for an albedo of 0.5 at 10 m. It is proportional to
  /// range² / albedo. Those of 16 and 120 MHz are 0.65 and 1.27 times as large at equal amplitudes,
  /// the ratios of the Kinect v2.
  double sigma_at_10_m_rad = 0;
  /// Added to the range that each frequency measures.
  std::array<double, 3> range_bias_m{0, 0, 0};
  unsigned seed = 1;
};

/// What the camera measures: phasors amplitude · exp(2πi · range / λ) with complex Gaussian noise.
/// Amplitudes are in libfreenect2's unit, such that σ = 1 / (γ₀ amplitude) with the γ₀ of
/// kinect_v2_noise. Without noise, the amplitude for an albedo of 0.5 at 10 m is 30. NaN ranges
/// give NaN.
ThreePhases measure(const SceneView& view, const NoiseOptions& options);

}  // namespace tofmap::peers
