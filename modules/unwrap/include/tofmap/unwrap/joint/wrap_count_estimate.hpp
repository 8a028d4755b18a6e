// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// How counts are estimated.
struct WrapCountOptions {
  WrapCountPrior prior;
  int iterations = 3;
  int scales = 3;  ///< pixels, blocks of 2 x 2, of 4 x 4 …, as far as the noise asks for it
};

/// Phases and their noise; NaN where there is no return.
struct NoisyFrame {
  DualFrequencyFrame frame;
  PhaseSigma sigma;
};

/// A frame of half the size: phasors, averaged over blocks of 2 x 2 pixels, and the noise of their
/// phases. A block without any return is NaN. Without amplitudes all phasors weigh the same; the
/// frame of half the size has amplitudes, which say how well phasors agree.
NoisyFrame halve(const DualFrequencyFrame& frame, const PhaseSigma& sigma);

/// Estimates the wrap counts of frames by belief propagation, at several scales where noise is
/// large. Phases are NaN where there is no return; counts are invalid there. Buffers persist, so
/// that frames of one size cost few allocations.
class WrapCountEstimator {
 public:
  /// `residual_sigma_m` is what the residual between the frequencies has besides noise.
  WrapCountBeliefs estimate(const DualFrequencyFrame& frame, const UnwrapLimits& limits,
                            const PhaseSigma& sigma, double residual_sigma_m,
                            const WrapCountOptions& options);

 private:
  /// What is seen at one scale: pixels, or blocks of them.
  struct Scale {
    NoisyFrame blocks;  ///< empty at the scale of pixels
    WrapCountModel model;
    WrapCountPropagation propagation;
    WrapCountBeliefs beliefs;
  };

  int divide(const DualFrequencyFrame& frame, const PhaseSigma& sigma, int most);

  std::vector<Scale> scales_;
};

}  // namespace tofmap
