// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap {

/// The methods of unwrapping. "The paper" is Droeschel, Holz, Behnke: Multi-frequency Phase
/// Unwrapping for Time-of-Flight Cameras, IROS 2010; docs/unwrapping.md describes each method.
enum class UnwrapMethod {
  joint,   ///< belief propagation over the wrap counts of all pixels, from all frequencies
  none,    ///< no unwrapping: wrap count 0 in every pixel
  pixel,   ///< equation 2 of the paper in each pixel by itself, for any number of wraps
  single,  ///< phase jumps from one frequency alone: `jump` without frequency term and residual
  jump,    ///< the paper's phase jumps, integrated so that wrap counts agree with the residual
  paper,   ///< the paper as printed: phase jumps and two wrap counts
};

/// The names of all methods, the recommended one first.
std::span<const NamedValue<UnwrapMethod>> named_values(UnwrapMethod);

/// True for the methods that estimate phase jumps: `paper`, `jump` and `single`.
bool finds_jumps(UnwrapMethod method);

/// The options of unwrapping, group `unwrap` of the option table. Symbols and equation numbers are
/// those of docs/unwrapping.md.
struct UnwrapOptions {
  /// The method that finds the wrap counts.
  UnwrapMethod method = UnwrapMethod::joint;

  /// Longest range in the scene, metres, 0 … 100000. It limits the wrap counts. 0: the limit that
  /// the recording states, or else the range up to which the frequencies are unambiguous at
  /// a noise of 0.05 cycles. `paper` uses two wrap counts, whatever the limit is.
  double max_range_m = 0;

  // Options of joint.

  /// Iterations of belief propagation over wrap counts, at every pyramid level; 1 … 1000.
  int count_iterations = 3;

  /// Largest number of pyramid levels, 1 … 6. Level s, counted from 0, has blocks of 2^s x 2^s
  /// pixels. Coarser levels are used only as far as the phase noise of the frame requires. 1: only
  /// single pixels.
  int scales = 3;

  /// ε of equation 11: probability that a pixel's residual comes from no surface, as at flying
  /// pixels; 1e-6 … 0.99. A larger value gives the residual of a single pixel less weight.
  double outlier_share = 0.4;

  /// s of equation 12: typical difference between the true ranges of neighbouring pixels on one
  /// surface, metres, 0.001 … 10. It is doubled at each coarser pyramid level.
  double slope_m = 0.2;

  /// Whether an edge between surfaces is more probable where the amplitude changes (equation 13).
  bool amplitude_edges = true;

  /// Whether the residual of mixed pixels is ignored, so that their neighbours decide their wrap
  /// counts. Mixed pixels are those whose amplitude lies clearly between the amplitudes of two
  /// opposite neighbours. Needs amplitudes.
  bool mixed_pixels = true;

  /// Whether the range is the mean of all frequencies, weighted by inverse variances
  /// (fuse_ranges). False: the range of the first frequency alone.
  bool fuse_frequencies = true;

  // Options of joint and jump.

  /// Whether the camera's motion between the exposures of the first frequency and each other one is
  /// estimated and removed from the latter.
  /// False: an offset between the frequencies absorbs the motion. No effect without
  /// `systematic_errors`.
  bool correct_exposure = true;

  /// Whether the systematic errors in which the frequencies differ are estimated, from all frames
  /// so far, and removed from all but the first (ErrorTracker). False: residuals are attributed to
  /// noise alone.
  bool systematic_errors = true;

  // Options of jump, paper and single.

  /// The two frequencies that are compared, counted from 1 in the order of the recording; 0 … 8. 0
  /// leaves it to compared_pair(). `single` uses the first of them alone.
  int pair_first = 0;
  int pair_second = 0;  ///< see pair_first

  /// Largest number of iterations of belief propagation over phase jumps, 1 … 1000. It stops
  /// earlier if every loop of 2 x 2 pixels satisfies the zero-curl constraint.
  int iterations = 5;

  /// c_d of equation 4: trust in the discontinuity term, which compares the phases of neighbouring
  /// pixels; 0 … 1. 0: the term has no effect.
  double trust_discontinuity = 0.9;

  /// c_f of equation 4: trust in the frequency term, which compares the two frequencies; 0 … 1.
  /// 0: the term has no effect. Not for `single`.
  double trust_frequency = 0.5;

  /// k of equation 3: pixels on each side of a phase jump over which the frequency term takes its
  /// medians; 1 … 99. Not for `single`.
  int window_px = 5;

  /// σ of equations 1 and 3: standard deviation of the true phase differences between neighbouring
  /// pixels, cycles, 0.001 … 10. Equation 1 adds the phase noise of both pixels. Not for `paper`,
  /// which estimates σ from the image.
  double sigma_cycles = 0.07;

  /// κ of equation 10, 0 … 1e6, for `jump` alone: two regions stay separate if joining them raises
  /// the cost of their residuals by more than κ times the log odds of the phase jump between them.
  /// A very large value lets all regions be joined.
  double objection_share = 1;

  /// Name, range, unit and meaning of every option.
  static std::vector<OptionField<UnwrapOptions>> fields();
};

}  // namespace tofmap
