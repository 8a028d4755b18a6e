// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// The probabilities of the configurations of all jump nodes. A jump node sits between two
/// neighbouring pixels p and q, where q is right of p or below it. Configuration i = −1, 0, +1 of
/// the paper means n(q) − n(p) = −i, so at −1 the wrap count grows by one. Index i + 1 of each
/// array is the plane of configuration i.
///
/// If p or q has no return, the node is absent, and NaN in all three planes.
struct JumpProbabilities {
  std::array<ImageF, 3> x;  ///< s_x(x, y), between (x, y) and (x + 1, y): rows x (cols − 1)
  std::array<ImageF, 3> y;  ///< s_y(x, y), between (x, y) and (x, y + 1): (rows − 1) x cols
};

/// Medians along one direction on both sides of every jump node (figure 6 of the paper). Windows
/// are cut short at the border of the image. NaNs are left out; a window of NaNs alone gives NaN.
/// Of an even number of values, the median is the lower one of the two in the middle.
struct SideMedians {
  ImageF neg;  ///< over the k pixels that end with p
  ImageF pos;  ///< over the k pixels that begin with q
};

/// The medians along rows, for the nodes of JumpProbabilities::x; `window_px` is k, at least 1.
SideMedians side_medians_x(const ImageF& image, int window_px);

/// The medians along columns, for the nodes of JumpProbabilities::y; `window_px` is k, at least 1.
SideMedians side_medians_y(const ImageF& image, int window_px);

/// The parameters of the evidence for phase jumps.
struct JumpTerms {
  double sigma_cycles;  ///< σ of both terms: standard deviation of the true phase differences
                        ///< between neighbouring pixels
  int window_px;        ///< k: pixels on each side of a jump over which medians are taken
  double trust_discontinuity;  ///< c_d of equation 4, 0 … 1
  double trust_frequency;      ///< c_f of equation 4, 0 … 1
};

/// Computes the evidence for each configuration of every jump node, equation 4:
///
///   P(i) ∝ ((1 − c_d) + c_d f_d(i)) ((1 − c_f) + c_f f_f(i)),
///
/// normalised over i = −1, 0, +1; each product is at least 1e-6.
///
/// Discontinuity term, equation 1, with the wrapped phases φ of A in cycles:
///
///   f_d(i) = exp(−(φ(q) − φ(p) − i)² / 2σ²)
///
/// The variances of the phase noise of p and q are added to σ²; `noise_cycles` holds the standard
/// deviation of each pixel.
///
/// Frequency term, equation 3, with the medians of the wrapped phase and of its reconstruction R̂,
/// in cycles:
///
///   f_f(i) = exp(−(|m_R̂^neg − m_A^neg| − |m_R̂^pos − m_A^pos| − i)² / 2σ²)
///
/// The difference of the absolute values is limited to −1 … 1, since it may be larger if R̂ has
/// several wraps. If `reconstruction_cycles` is empty (0 x 0), the frequency term is left out.
///
/// `out` is resized. A node is absent, NaN, where the phase of p or q is NaN.
void find_jump_evidence(const ImageF& phase, const ImageF& noise_cycles,
                        const ImageF& reconstruction_cycles, const JumpTerms& terms,
                        JumpProbabilities& out);

}  // namespace tofmap
