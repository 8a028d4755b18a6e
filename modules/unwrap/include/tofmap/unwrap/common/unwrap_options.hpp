// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap {

enum class UnwrapMethod {
  joint,   ///< beliefs over wrap counts, from both frequencies and all pixels together
  none,    ///< wrapped: count 0 everywhere
  pixel,   ///< equation 2 for any number of wraps: each pixel by itself
  single,  ///< phase jumps from one frequency: `jump` without its frequency term and the residual
  jump,    ///< the paper's phase jumps, integrated with regard to the inter-frequency residual
  paper,   ///< the paper to the letter
};

/// The names of all methods, the best first.
std::span<const NamedValue<UnwrapMethod>> named_values(UnwrapMethod);

/// Whether the method goes by phase jumps: `paper`, `jump` and `single` do.
bool finds_jumps(UnwrapMethod method);

/// The options of unwrapping, group `unwrap`. docs/unwrapping.md has the effect of each.
struct UnwrapOptions {
  UnwrapMethod method = UnwrapMethod::joint;
  double max_range_m = 0;
  // Of joint.
  int count_iterations = 3;
  int scales = 3;
  double outlier_share = 0.4;
  double slope_m = 0.2;
  bool amplitude_edges = true;
  bool mixed_pixels = true;
  bool fuse_frequencies = true;
  bool correct_exposure = true;
  // Of joint and jump.
  bool systematic_errors = true;
  // Of jump, paper and single.
  int iterations = 5;
  double trust_discontinuity = 0.9;  ///< c_d of the paper
  double trust_frequency = 0.5;      ///< c_f
  int window_px = 5;                 ///< k
  double sigma_cycles = 0.07;        ///< σ of f_d and f_f; `paper` takes it from the image
  double objection_share = 1;

  static std::vector<OptionField<UnwrapOptions>> fields();
};

}  // namespace tofmap
