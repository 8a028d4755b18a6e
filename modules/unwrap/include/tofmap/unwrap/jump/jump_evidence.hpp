// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include <tofmap/core/image.hpp>

namespace tofmap {

/// Three probabilities (or messages) a jump node, as planes: index i + 1 holds configuration
/// i = −1, 0, +1 of the paper. Configuration i between pixels p and q, q right of or below p,
/// means n(q) − n(p) = −i: at −1 the wrap count grows by one.
///
/// x holds s_x(x, y), between (x, y) and (x + 1, y): rows x (cols − 1).
/// y holds s_y(x, y), between (x, y) and (x, y + 1): (rows − 1) x cols.
/// A node that is absent is NaN in all three planes.
struct JumpProbabilities {
  std::array<ImageF, 3> x;
  std::array<ImageF, 3> y;
};

/// Medians along one direction on both sides of every jump node (figure 6 of the paper):
/// `neg` over the k pixels up to and with p, `pos` over the k pixels from q on. NaNs are left
/// out, borders cut windows short; of an even number the lower of the two middle values.
/// NaN where a window holds no number.
struct SideMedians {
  ImageF neg;
  ImageF pos;
};
SideMedians side_medians_x(const ImageF& image, int window_px);
SideMedians side_medians_y(const ImageF& image, int window_px);

/// How much each term is trusted (equation 4), and how it is made.
struct JumpTerms {
  double sigma_cycles;         ///< σ of both terms: of true differences between neighbours
  int window_px;               ///< k, pixels on each side of a jump in the medians
  double trust_discontinuity;  ///< c_d
  double trust_frequency;      ///< c_f
};

/// The evidence for each configuration of every jump node, from both terms:
/// ((1 − c_d) + c_d f_d) ((1 − c_f) + c_f f_f), normalised; no configuration gets less than 1e-6.
///
/// Equation 1: f_d(i) = exp(−(φ(q) − φ(p) − i)² / 2σ²), of wrapped phases in cycles. To σ² come the
/// variances of the noise of p and q (`noise_cycles`, a standard deviation a pixel): a noisy
/// difference says little.
///
/// Equation 3: f_f(i) = exp(−(|m_R̂^neg − m_A^neg| − |m_R̂^pos − m_A^pos| − i)² / 2σ²), with medians
/// of the wrapped phase and of its reconstruction R̂, in cycles. Where R̂ holds several wraps the
/// inner difference may pass ±1; it is then taken as ±1, the nearest that a configuration can say.
/// Without R̂, an image of no pixels, there is no f_f.
///
/// A node is absent where the phase of p or q is NaN.
void find_jump_evidence(const ImageF& phase, const ImageF& noise_cycles,
                        const ImageF& reconstruction_cycles, const JumpTerms& terms,
                        JumpProbabilities& out);

}  // namespace tofmap
