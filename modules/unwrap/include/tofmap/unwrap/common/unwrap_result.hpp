// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

/// What unwrapping says of one frame.
struct UnwrapResult {
  RangeImage image;
  FrameErrors errors = {};        ///< of joint and jump; nothing is known of others
  int iterations = 0;             ///< of belief propagation; 0 for none and pixel
  int curl_violations = 0;        ///< curl nodes that are not zero when it ended
  std::optional<bool> converged;  ///< whether no curl is left; empty for methods without jumps
  double phase_noise_cycles = 0;  ///< estimated; median over the pixels with a return
  int regions = 0;                ///< anchored each by itself; 0 for none and pixel
};

}  // namespace tofmap
