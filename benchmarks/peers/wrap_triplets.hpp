// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/three_phases.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace tofmap::peers {

/// One wrap count for each frequency.
using WrapTriplet = std::array<std::uint8_t, 3>;

/// The wrap counts that occur together within the non-ambiguity range of three frequencies, and the
/// factors that make their phases comparable (Järemo Lawin et al. 2016, section 2).
struct WrapTriplets {
  /// k_m = L / f_m, where L is the least common multiple of the frequencies: 3, 15 and 2 for the
  /// Kinect v2. k_m (phase + count) is the same for all frequencies m if there is no noise; the
  /// paper calls it pseudo-distance.
  std::array<double, 3> multiplier;
  /// In the order of increasing range. Where several frequencies wrap at the same range, noise can
  /// make any of them wrap first, so that there is a triplet for every subset of them.
  std::vector<WrapTriplet> triplets;
  double non_ambiguity_range_m;
};

/// Throws UsageError if the frequencies, rounded to kHz, have no common non-ambiguity range in
/// which each wraps at most 255 times.
WrapTriplets wrap_triplets(const std::array<double, 3>& frequencies_hz, double speed_of_light_m_s);

}  // namespace tofmap::peers
