// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/jump_evidence.hpp>
#include <tofmap/unwrap/jump_propagation.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {

/// Phase jumps of one frame, stage by stage: what figure 7 of the paper shows.
struct JumpEstimate {
  JumpProbabilities discontinuity;  ///< f_d, not normalised
  JumpProbabilities frequency;      ///< f_f, not normalised; empty for the method `single`
  JumpProbabilities evidence;       ///< both fused
  JumpBeliefs beliefs;              ///< after propagation
  ImageU8 nearest;                  ///< nearest_pair_counts; empty for the method `single`
};

/// Estimates the phase jumps of a frame whose phases are NaN where there is no return, for the
/// methods `jump` and `single`.
JumpEstimate estimate_jumps(JumpPropagation& propagation, const DualFrequencyFrame& frame,
                            const BeatLimits& limits, const PhaseNoise& noise,
                            const UnwrapOptions& options);

/// The same, once.
JumpEstimate estimate_jumps(const DualFrequencyFrame& frame, const BeatLimits& limits,
                            const PhaseNoise& noise, const UnwrapOptions& options);

}  // namespace tofmap
