// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

enum class UnwrapMethod {
  none,    ///< wrapped: count 0 everywhere
  pixel,   ///< equation 2 for any number of wraps: each pixel by itself
  single,  ///< the paper without its frequency term; needs no second frequency
  jump,    ///< the paper
};

/// The options of unwrapping, group `unwrap`. docs/unwrapping.md has the effect of each.
struct UnwrapOptions {
  std::string method = "jump";
  double max_range_m = 0;
  int iterations = 10;
  double trust_discontinuity = 0.9;  ///< c_d of the paper
  double trust_frequency = 0.5;      ///< c_f
  int window_px = 5;                 ///< k
  double sigma_cycles = 0.07;        ///< σ of f_d and f_f
  double objection_share = 1;

  static std::vector<OptionField<UnwrapOptions>> fields();
};

/// The method that the options name. Throws UsageError if there is none of that name.
UnwrapMethod unwrap_method(const UnwrapOptions& options);

struct UnwrapResult {
  RangeImage image;
  int iterations = 0;                 ///< of belief propagation; 0 for none and pixel
  int curl_violations = 0;            ///< curl nodes that are not zero when it ended
  bool converged = true;              ///< no curl is left
  double largest_message_change = 0;  ///< in the last iteration
  double phase_noise_cycles = 0;      ///< estimated; median over the pixels with a return
  int regions = 0;                    ///< anchored each by itself; 0 for none and pixel
};

/// Finds how many wavelengths to add to the phase of A in every pixel
/// (Droeschel, Holz, Behnke: Multi-frequency Phase Unwrapping for Time-of-Flight Cameras, 2010).
///
/// range_m is (phase_a + n) λ_A, radial. Pixels without a return at either frequency are
/// invalid (no_return) and take no part, for every method, so that methods compare.
/// sigma_m is what the phase noise, estimated from this frame, makes of A's range.
/// confidence combines what the beat of the pixel says of its count with what the jump nodes
/// around it say; it orders pixels, and is not calibrated yet.
/// Works on one frame at a time; the same frame and options give the same bits.
/// Throws UsageError if images differ in size or options are not allowed.
UnwrapResult unwrap(const DualFrequencyFrame& frame, const SensorModel& sensor,
                    const UnwrapOptions& options);

}  // namespace tofmap
