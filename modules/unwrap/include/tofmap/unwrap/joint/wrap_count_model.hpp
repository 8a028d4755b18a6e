// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/range_error.hpp>
#include <tofmap/unwrap/common/diagonal_layout.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>
#include <tofmap/unwrap/joint/wrap_count_factors.hpp>

namespace tofmap {

/// The probabilities of the wrap counts of all pixels as a factor graph on the pixel grid
/// (docs/unwrapping.md, equations 11 to 14). All values are stored diagonal by diagonal
/// (DiagonalLayout).
///
/// Unary factors, `evidence`: how well each wrap count of a pixel fits the pixel's
/// residuals, tempered, relative to the best wrap count, which has 1.
///
/// Pairwise factors, `right` and `down`: ψ(i) of a pixel p and its neighbour q for the step
/// i = n(q) − n(p), tempered. Only two steps can bring the ranges of p and q close together: 0, and
/// either +1 or −1. All other steps have ψ = 1, so Edges holds ψ − 1 of these two.
class WrapCountModel {
 public:
  /// The pairwise factors of all pixels and one of their neighbours, stored at the left or upper
  /// pixel. 0 where either pixel has no return.
  struct Edges {
    std::vector<float> same;  ///< ψ(0) − 1
    std::vector<float> next;  ///< ψ(+1) − 1 if positive; the negative of ψ(−1) − 1 if negative
  };

  /// Builds the model of a frame, which replaces the previous one. Phases must be NaN where there
  /// is no return. `sigma` is the noise of the phases; `residual_sigma_m` has for each frequency
  /// the standard deviation of its residual to the first one besides noise. Reuses the memory of
  /// the previous model if the frame has the same size.
  void assign(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
              const std::vector<double>& residual_sigma_m, const WrapCountPrior& prior);

  /// Multiplies the unary factors of a pixel by `factors`, one for each wrap count, and scales them
  /// so that the largest is 1.
  void weigh_evidence(int row, int col, std::span<const float> factors);

  const DiagonalLayout& layout() const { return layout_; }

  /// The number of wrap counts.
  int counts() const { return counts_; }

  /// The unary factors as bfloat16 numbers, with one plane of layout() for each wrap count.
  const std::vector<std::uint16_t>& evidence() const { return evidence_; }

  /// The unary factors of one pixel for all wrap counts. Slow; for tests and inspection.
  std::vector<double> evidence_of(int row, int col) const;

  const Edges& right() const { return right_; }
  const Edges& down() const { return down_; }

 private:
  void resize(int rows, int cols, int counts);
  void load(const Frame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
            const std::vector<double>& residual_sigma_m);
  void fill_unary(const UnwrapLimits& limits);
  void fill_pairwise(const UnwrapLimits& limits, const WrapCountPrior& prior);
  void mark_mixed_pixels(const ImageU8& mixed);

  DiagonalLayout layout_;
  int counts_ = 0;
  std::vector<std::uint16_t> evidence_;  ///< bfloat16
  Edges right_;
  Edges down_;
  PixelArrays measured_;  ///< diagonal by diagonal
};

}  // namespace tofmap
