// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "peers/three_phases.hpp"

namespace tofmap::peers {

/// The defaults are those of libfreenect2 (DepthPacketProcessor::Parameters).
struct SmoothingOptions {
  double spatial_sigma_px = 3;
  /// The weight of a neighbour is exp(−steepness · d), d = (1 − cos Δφ) / 2. libfreenect2 writes
  /// 1.442695 · 5.
  double steepness = 7.213475;
  /// Weaker neighbours have no weight, unless the pixel itself is weaker, too: then, all have their
  /// spatial weight alone. In libfreenect2's unit.
  double min_amplitude = 3;
  /// A pixel whose d of its neighbours add to this or more at any frequency is on an edge.
  double edge_limit = 2.5;
};

struct SmoothedPhases {
  ThreePhases phases;
  ImageU8 on_edge;  ///< 1 where the edge limit is reached
};

/// libfreenect2's bilateral filter: averages the phasors of each frequency over 3 × 3 pixels,
/// weighted by the similarity of their phases. The outermost pixels stay as they are. Neighbours
/// without a return have no weight. `phases` must be calibrated(). Both libfreenect2's processor
/// and the KDE processors run it before unwrapping if it is switched on, which is the default.
SmoothedPhases smooth_phases(const ThreePhases& phases, const SmoothingOptions& options = {});

}  // namespace tofmap::peers
