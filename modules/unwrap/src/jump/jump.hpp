// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tofmap/unwrap/common/unwrap_result.hpp"
#include "tofmap/unwrap/errors/measured_frame.hpp"
#include "tofmap/unwrap/jump/jump_estimate.hpp"

namespace tofmap {

/// The methods `paper`, `jump` and `single`: computes the evidence for phase jumps, propagates
/// beliefs, and integrates the jumps into absolute wrap counts.
UnwrapResult unwrap_by_jumps(JumpEstimator& estimator, const MeasuredFrame& frame,
                             const PairLimits& limits, const JumpMethod& method,
                             const UnwrapOptions& options);

}  // namespace tofmap
