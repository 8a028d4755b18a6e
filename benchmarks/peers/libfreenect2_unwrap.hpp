// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/phase_smoothing.hpp"
#include "peers/three_phases.hpp"

#include <cstdint>

namespace tofmap::peers {

/// The defaults are those of libfreenect2 (DepthPacketProcessor::Parameters), but for the largest
/// range: its default configuration keeps 0.5 to 4.5 m.
struct Libfreenect2Options {
  CameraFacts camera;
  bool smooth = true;  ///< its bilateral filter before unwrapping
  SmoothingOptions smoothing;
  /// Rejects weak and inconsistent pixels and, with `edge_filter`, those at edges. Without it,
  /// every pixel whose range is positive and within the limits is kept.
  bool reject_outliers = true;
  bool edge_filter = true;
  double min_amplitude = 3;       ///< of each frequency
  double min_amplitude_sum = 10;  ///< of the three frequencies
  /// The unwrapped phases may be this far from agreement: the angle
  /// clamp(scale · (largest amplitude)^exponent, min, max). libfreenect2 has 20° and 35°.
  double agreement_scale_rad = 12.886;  ///< exp(0.7694894 · 3.321928)
  double agreement_exponent = -0.5330578;
  double min_agreement_rad = 0.3490659;
  double max_agreement_rad = 0.6108653;
  /// Edge filter: a pixel is rejected if the relative standard deviation of the amplitudes around
  /// it is at least the first number, and its range is farther from the nearest and the farthest
  /// one around it than the others say.
  double edge_amplitude_deviation = 0.05;
  double edge_amplitude_floor = 50;  ///< mean amplitudes count as at least this
  double edge_behind_nearest_m = 0.05;
  double edge_before_farthest_m = 0.03;
  double edge_either_m = 0.1;
  double min_range_m = 0.5;
  double max_range_m = 18.75;
};

/// Why libfreenect2 has no range for a pixel.
enum class Rejection : std::uint8_t {
  none,
  no_return,
  weak,          ///< an amplitude or their sum is too small
  inconsistent,  ///< the frequencies do not agree
  out_of_range,
  edge,
};

struct Libfreenect2Result {
  ImageF range_m;      ///< radial; NaN where `rejection` is not none
  ImageU8 rejection;   ///< a Rejection
  ImageU8 wrap_count;  ///< of 80 MHz; 255 where there is no count or it is negative
};

/// Unwraps the phases of a Kinect v2 as libfreenect2's CpuDepthPacketProcessor does. With the
/// pseudo-distances T = (3 φ₈₀, 15 φ₁₆, 2 φ₁₂₀):
///
/// 1. The count of 80 MHz is ⌊(T₁₆ − T₈₀) / 3⌉, within one cycle of 16 MHz.
/// 2. Then, T₈₀ − T₁₂₀ is nearly even if 16 MHz has not wrapped and nearly odd if it has, as a
/// cycle
///    has 15 units.
/// 3. The count of 120 MHz is the one that fits the unwrapped phase of 80 MHz best.
/// 4. The range is the mean of the three unwrapped phases in cycles of their mean frequency.
/// 5. The vector of unwrapped phases must be close to the line along which the range moves it.
///
/// Every pixel is unwrapped on its own. The term of libfreenect2 for the light source beside the
/// lens is left out: ranges are halves of paths. Throws UsageError unless the frequencies are as
/// 10 : 2 : 15, or for images that are not allowed.
Libfreenect2Result libfreenect2_unwrap(const ThreePhases& measured,
                                       const Libfreenect2Options& options = {});

}  // namespace tofmap::peers
