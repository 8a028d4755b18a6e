// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/count_model.hpp>
#include <tofmap/unwrap/count_propagation.hpp>
#include <tofmap/unwrap/phase_noise.hpp>

namespace tofmap {

/// How counts are estimated.
struct CountEstimation {
  CountPrior prior;
  int iterations = 3;
  int scales = 3;  ///< pixels, blocks of 2 x 2, of 4 x 4 …, as far as the noise asks for it
};

/// A frame of half the size: phasors, averaged over blocks of 2 x 2 pixels. Amplitudes are scaled
/// so that half the scale of the phase noise holds for them, also for blocks where pixels are
/// missing. A block without any return is NaN.
DualFrequencyFrame halve(const DualFrequencyFrame& frame);

/// Estimates the wrap counts of frames by belief propagation, at several scales where noise is
/// large. Phases are NaN where there is no return; counts are invalid there. Buffers persist, so
/// that frames of one size cost few allocations.
class CountEstimator {
 public:
  CountBeliefs estimate(const DualFrequencyFrame& frame, const BeatLimits& limits,
                        const PhaseNoise& noise, const CountEstimation& options);

 private:
  /// What is seen at one scale: pixels, or blocks of them.
  struct Scale {
    DualFrequencyFrame blocks;  ///< empty at the scale of pixels
    PhaseNoise noise;
    CountModel model;
    CountPropagation propagation;
    CountBeliefs beliefs;
  };

  int divide(const DualFrequencyFrame& frame, const PhaseNoise& noise, int most);

  std::vector<Scale> scales_;
};

}  // namespace tofmap
