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
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {

/// What is assumed of scenes, for the method `joint`. docs/unwrapping.md has the effect of each.
struct WrapCountPrior {
  double outlier_share = 0.4;   ///< how much of the evidence of a pixel is thought to be any
  double slope_m = 0.2;         ///< typical difference of true ranges between neighbours
  double edge_share = 0.02;     ///< neighbours on different surfaces, at equal amplitude
  double edge_reach_m = 25;     ///< steps from one surface to another lie within ± this
  bool amplitude_edges = true;  ///< edges are likelier where the amplitude changes
  bool mixed_pixels = true;  ///< pixels between bright and dark neighbours know nothing themselves
};

/// Probabilities of the wrap counts of all pixels, as a grid of factors (docs/unwrapping.md,
/// equations 11 to 14), stored diagonal by diagonal.
///
/// evidence: of each pixel for each count, from its residual; the best is 1.
/// right, down: of each pixel and that neighbour for the two steps in count that make their ranges
/// lie close, relative to all other steps, which count 0: `same` for no step, `next` for the other;
/// that is one up if the number is positive, one down, of its absolute value, if it is negative.
class WrapCountModel {
 public:
  struct Edges {
    std::vector<float> same;
    std::vector<float> next;
  };

  /// Replaces the model by that of a frame, whose phases are NaN where there is no return. `sigma`
  /// is the noise of its phases, `residual_sigma_m` what their residual has besides, as systematic
  /// errors make it. Keeps its memory, so that frames of one size cost no allocation.
  void assign(const DualFrequencyFrame& frame, const UnwrapLimits& limits, const PhaseSigma& sigma,
              double residual_sigma_m, const WrapCountPrior& prior);

  /// Multiplies the evidence of a pixel by a factor for each count. The best is 1 again then.
  void weigh_evidence(int row, int col, std::span<const float> factors);

  const DiagonalLayout& layout() const { return layout_; }
  int counts() const { return counts_; }
  const std::vector<std::uint16_t>& evidence() const { return evidence_; }
  /// The evidence of one pixel for every count: for tests and for those who look closely.
  std::vector<double> evidence_of(int row, int col) const;

  const Edges& right() const { return right_; }
  const Edges& down() const { return down_; }

 private:
  void resize(int rows, int cols, int counts);
  void mark_mixed_pixels(const ImageF& amplitude, const ImageF& sigma_cycles);

  DiagonalLayout layout_;
  int counts_ = 0;
  std::vector<std::uint16_t> evidence_;  ///< upper halves of floats
  Edges right_;
  Edges down_;
  // What a frame says of its pixels, diagonal by diagonal.
  std::vector<float> phase_a_;
  std::vector<float> phase_b_;
  std::vector<float> amplitude_;
  std::vector<float> variance_a_m2_;
  std::vector<float> variance_b_m2_;
  std::vector<float> outlier_share_;
};

}  // namespace tofmap
