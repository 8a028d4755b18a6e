// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/frame_errors.hpp>

namespace tofmap {

/// What unwrapping says of one frame.
struct UnwrapResult {
  RangeImage image;
  FrameErrors errors = {};            ///< of joint and jump; nothing is known of others
  int iterations = 0;                 ///< of belief propagation; 0 for none and pixel
  int curl_violations = 0;            ///< curl nodes that are not zero when it ended
  bool converged = true;              ///< no curl is left
  double largest_message_change = 0;  ///< in the last iteration
  double phase_noise_cycles = 0;      ///< estimated; median over the pixels with a return
  int regions = 0;                    ///< anchored each by itself; 0 for none and pixel
};

}  // namespace tofmap
