// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/frame_halving.hpp>
#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/sparse_propagation.hpp>
#include <tofmap/unwrap/joint/uncertain_pixels.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// The options of WrapCountEstimator. UnwrapOptions has their ranges.
struct WrapCountOptions {
  /// The assumptions about scenes.
  WrapCountPrior prior;
  /// Iterations of belief propagation at every pyramid level; at least 1.
  int iterations = UnwrapOptions{}.count_iterations;
  /// Largest number of pyramid levels, at least 1. Level s, counted from 0, has blocks of 2^s x 2^s
  /// pixels. Coarser levels are used only as far as the phase noise of the frame requires.
  int scales = UnwrapOptions{}.scales;
};

/// Estimates the wrap counts of frames by belief propagation, in noisy frames at several pyramid
/// levels from coarse to fine (docs/unwrapping.md, 'Joint: beliefs over counts'). The object keeps
/// its buffers, so frames of the same size need few allocations.
class WrapCountEstimator {
 public:
  /// Estimates the wrap counts of a frame whose phases are NaN at all frequencies where one of them
  /// has no return; in these pixels the wrap count is invalid_wrap_count and its probability 0.
  /// `sigma` is the noise of the phases, `residual_sigma_m` has for each frequency the standard
  /// deviation of its residual to the first one besides noise. `iterations` of the result is the
  /// sum over all pyramid levels.
  WrapCountBeliefs estimate(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                            const std::vector<double>& residual_sigma_m,
                            const WrapCountOptions& options);

 private:
  /// One pyramid level.
  struct Scale {
    NoisyFrame blocks;  ///< empty at the level of pixels
    /// Whether only uncertain pixels are in the model, as with three or more frequencies.
    bool is_sparse = false;
    bool is_loud = false;        ///< many pixels need the wrap counts of a coarser level
    bool needs_coarser = false;  ///< is_loud, or a coarser level saves time
    OwnCounts own;
    ImageU8 mixed;
    UncertainPixels uncertain;
    SparsePropagation sparse;
    WrapCountModel model;
    WrapCountPropagation propagation;
    WrapCountBeliefs beliefs;

    /// Finds what the level tells by itself.
    void begin(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
               const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior);
    /// Decides whether a coarser level is worth its time.
    void look_for_noise(const PhaseSigma& sigma);
    /// Completes the model by the beliefs of the next coarser level, if there is one.
    void build(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
               const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
               const Scale* coarser);
    void run(int iterations);
  };

  std::vector<Scale> scales_;
};

}  // namespace tofmap
