// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// What WrapCountModel and WrapCountPropagation compute, for the pixels alone whose wrap counts are
/// not certain. Certain neighbours send them constant messages: those of a belief in one wrap
/// count. Everything is stored pixel by pixel, in the order of rows. The object keeps its buffers.
class SparsePropagation {
 public:
  /// Builds the model of a frame, which replaces the previous one. `own` and `mixed` are those of
  /// the same frame; the other arguments are as in WrapCountModel::assign.
  void assign(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
              const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
              const OwnCounts& own, const ImageU8& mixed);

  /// The number of uncertain pixels.
  std::size_t size() const { return raster_.size(); }

  /// The index of an uncertain pixel, row by row, in its frame.
  int raster(std::size_t pixel) const { return raster_[pixel]; }

  /// Multiplies the unary factors of an uncertain pixel by `factors`, one for each wrap count.
  void weigh_evidence(std::size_t pixel, std::span<const float> factors);

  /// Runs a fixed number of iterations, at least 1. The beliefs of certain pixels are those of
  /// `own`, which must be that of assign().
  WrapCountBeliefs run(const OwnCounts& own, int iterations);

 private:
  enum Direction { left, above, right, below };

  void list_pixels(const Frame& frame, const OwnCounts& own);
  void load(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
            const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior,
            const ImageU8& mixed);
  void fill_unary(const UnwrapLimits& limits);
  void fill_pairwise(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
                     const WrapCountPrior& prior, const OwnCounts& own);
  void absorb(std::size_t pixel, int count, float same, float next);
  void scale_evidence(std::size_t pixel);

  int counts_ = 0;
  std::size_t stride_ = 0;            ///< of wrap counts: whole vectors
  std::vector<int> raster_;           ///< of each uncertain pixel
  std::vector<int> column_;           ///< of each uncertain pixel
  std::vector<int> place_;            ///< of each pixel of the frame in raster_; none, certain
  PixelArrays pixels_;                ///< the uncertain pixels
  PixelArrays neighbours_;            ///< of all of them in one direction
  std::vector<std::uint16_t> unary_;  ///< plane by plane
  std::vector<float> evidence_;       ///< unary factors times messages of certain neighbours
  /// Pairwise factors of the edges to the right and below, as in WrapCountModel::Edges.
  std::array<std::vector<float>, 2> same_;
  std::array<std::vector<float>, 2> next_;
  std::array<std::vector<int>, 4> neighbour_;  ///< uncertain ones; −1: none
  /// μ² along the edges to the left and above, then a slot of ones.
  std::vector<float> messages_;
  std::vector<float> before_;  ///< messages before the last iteration
};

}  // namespace tofmap
