// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/unwrap/common/unwrap_result.hpp>
#include <tofmap/unwrap/errors/measured_frame.hpp>
#include <tofmap/unwrap/joint/wrap_count_estimate.hpp>

namespace tofmap {

/// The method `joint`: finds wrap counts by belief propagation and fuses the ranges of all
/// frequencies. `frame` must have been measured for `joint`, so that its images are matched to
/// those of the first frequency.
UnwrapResult unwrap_jointly(WrapCountEstimator& estimator, const MeasuredFrame& frame,
                            const UnwrapLimits& limits, const UnwrapOptions& options);

}  // namespace tofmap
