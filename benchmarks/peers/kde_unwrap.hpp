// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/phase_noise.hpp"
#include "peers/phase_smoothing.hpp"
#include "peers/three_phases.hpp"

#include <array>
#include <cstdint>

namespace tofmap::peers {

/// How the ranges of the three frequencies become one.
enum class Fusion {
  /// By the mean of the unwrapped phases, which weights the ranges by their frequencies, as the
  /// authors' implementation and libfreenect2 do.
  mean_phase,
  /// By the inverse variances that PhaseNoise predicts.
  inverse_variance,
};

/// The defaults are those of the authors' implementation for the Kinect v2.
struct KdeOptions {
  CameraFacts camera;
  bool smooth = true;  ///< libfreenect2's bilateral filter before unwrapping
  SmoothingOptions smoothing;
  int hypotheses = 2;  ///< 2 or 3 wrap triplets a pixel, the set I of equation 11
  /// Weights of the squared differences between the pseudo-distances of the frequencies (0, 1),
  /// (0, 2) and (1, 2). Equal phase noises would make them 1, 18 and 1.0218.
  std::array<double, 3> residual_weights{1, 10, 1.0218};
  double unwrapping_scale = 2;             ///< s₁² of equation 15
  double phase_scale_rad2 = 3;             ///< s₂² of equation 23
  double kernel_bandwidth_m = 0.322;       ///< h of equation 13; √0.02393 cycles of 2.083 m
  int support_radius_px = 5;               ///< N(x) of equation 11 has 11 × 11 pixels
  double spatial_sigma_px = 2.5;           ///< of the Gaussian weights within N(x)
  double least_total_weight = 0.5;         ///< densities are divided by at least this weight
  double saturated_amplitude_sum = 26214;  ///< pixels at or above it have no weight
  std::array<PhaseNoise, 3> noise = kinect_v2_noise;
  Fusion fusion = Fusion::mean_phase;
  double min_range_m = 0.5;
  double max_range_m = 18.75;
  /// Pixels with a smaller confidence become invalid (equation 25). 0 keeps all.
  double min_confidence = 0.5;
};

inline constexpr std::uint8_t no_wrap_count = 255;

struct KdeResult {
  ImageF range_m;     ///< radial; NaN where there is no return or the confidence is too small
  ImageF confidence;  ///< the density at the range, 0 … 1; 0 without a return or beyond the limits
  ImageU8 wrap_count;  ///< of the first frequency, no_wrap_count without a return
};

/// Unwraps by "Efficient Multi-Frequency Phase Unwrapping using Kernel Density Estimation", Felix
/// Järemo Lawin, Per-Erik Forssén and Hannes Ovrén, ECCV 2016. Every pixel has two or three
/// hypotheses: the ranges r_i of the wrap triplets whose pseudo-distances T_m = k_m (φ_m + n_m)
/// agree best,
///
///   J_i = w₀₁ (T₀ − T₁)² + w₀₂ (T₀ − T₂)² + w₁₂ (T₁ − T₂)²
///
/// The one with the largest spatial kernel density is its range:
///
///   p(r; x) = Σ_{y ∈ N(x), j} w_j(y) exp(−(r − r_j(y))² / 2h²) / Σ_{y, j} w_j(y)
///   w_j(y)  = exp(−|x − y|² / 2σ²) exp(−J_j(y) / 2s₁²) exp(−Σ_m σ_m(y)² / 2s₂²)
///
/// Runs in one thread. Throws UsageError for options or images that are not allowed.
KdeResult kde_unwrap(const ThreePhases& measured, const KdeOptions& options = {});

}  // namespace tofmap::peers
