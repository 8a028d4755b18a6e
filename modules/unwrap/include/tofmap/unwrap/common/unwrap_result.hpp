// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

/// The result of unwrapping one frame.
struct UnwrapResult {
  RangeImage image;
  /// Of each frequency relative to the first one (MeasuredFrame::errors).
  std::vector<FrameErrors> errors = {};
  /// Iterations of belief propagation, for `joint` added over all pyramid levels; 0 for `none` and
  /// `pixel`.
  int iterations = 0;
  /// Loops of 2 x 2 pixels that violate the zero-curl constraint after belief propagation; 0 for
  /// methods without phase jumps.
  int curl_violations = 0;
  /// Whether every loop of 2 x 2 pixels satisfies the zero-curl constraint. Empty for methods
  /// without phase jumps.
  std::optional<bool> converged = std::nullopt;
  /// Estimated noise of A's phase: median over the pixels with a return.
  double phase_noise_cycles = 0;
  /// Regions whose absolute wrap count was found separately for each; 0 for methods without phase
  /// jumps.
  int regions = 0;
};

}  // namespace tofmap
