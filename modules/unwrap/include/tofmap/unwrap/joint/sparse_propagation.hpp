// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/uncertain_pixels.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {

/// What WrapCountPropagation computes, for uncertain pixels alone. Everything is stored pixel by
/// pixel, in the order of rows. The object keeps its buffers.
class SparsePropagation {
 public:
  /// Runs a fixed number of iterations, at least 1. The beliefs of certain pixels are those of
  /// `own`, which must be that of `pixels`.
  WrapCountBeliefs run(const UncertainPixels& pixels, const OwnCounts& own, int iterations);

 private:
  /// μ² along the edges to the left and above, then a slot of ones.
  std::vector<float> messages_;
  std::vector<float> before_;  ///< messages before the last iteration
};

}  // namespace tofmap
