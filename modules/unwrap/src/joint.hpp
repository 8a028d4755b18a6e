// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "measured_frame.hpp"

#include <tofmap/core/camera.hpp>
#include <tofmap/unwrap/count_estimate.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {

/// The method `joint`: counts by belief propagation, ranges from both frequencies. `rays` may be
/// empty, then B is not brought back to the instant of A.
UnwrapResult unwrap_jointly(CountEstimator& estimator, const MeasuredFrame& frame,
                            const BeatLimits& limits, const PixelRays& rays,
                            const UnwrapOptions& options);

}  // namespace tofmap
