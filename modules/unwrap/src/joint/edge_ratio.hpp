// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/fast_math.hpp"

#include <cmath>

#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {

/// Upper bound of the pairwise factors. It bounds the messages, so that products of messages do not
/// overflow or underflow.
inline constexpr float largest_ratio = 1e12F;

/// Its root.
inline constexpr float largest_root_ratio = 1e6F;

/// Equations 12 to 14, without tempering, for an edge between two pixels: how much more likely a
/// difference of their ranges is than one between unrelated surfaces.
class EdgeRatio {
 public:
  /// `variance_m2` is the sum of the variances of both ranges.
  [[gnu::always_inline]] EdgeRatio(const EdgeScale& scale, float variance_m2, float amplitude,
                                   float other_amplitude) {
    spread_m_ = std::sqrt(variance_m2 + scale.slope_m2);
    const float lesser = amplitude < other_amplitude ? amplitude : other_amplitude;
    const float greater = amplitude < other_amplitude ? other_amplitude : amplitude;
    const float likeness =
        scale.amplitude_weight * (lesser / greater) + (1 - scale.amplitude_weight);
    edge_ = 1 - (1 - scale.edge_share) * likeness;
    other_ = edge_ * scale.edge_density;
    wavelength_m_ = scale.wavelength_m;
  }

  /// For a difference in cycles.
  [[gnu::always_inline]] float operator()(float cycles) const {
    const float deviation = (cycles < 0 ? -cycles : cycles) * wavelength_m_ / spread_m_;
    const float surface = exp_of_negative(-deviation) / (2 * spread_m_);
    return ((1 - edge_) * surface + other_) / other_;
  }

 private:
  float spread_m_;
  float edge_;
  float other_;
  float wavelength_m_;
};

}  // namespace tofmap
