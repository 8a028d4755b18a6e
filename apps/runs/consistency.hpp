// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/frame.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// What tells without truth whether unwrapping was right (docs/evaluation.md); NaN: not known.
struct Consistency {
  double beat_misfit_percent = 0;
  double beat_residual_cycles = 0;
  double ambiguous_percent = 0;
  double contradicted_percent = 0;
  double plane_thickness_m = 0;
  double curl_violations_per_frame = 0;
};

/// Of which nothing is known.
Consistency unknown_consistency();

/// How many frames tell enough: 60; where images are large, since they are kept, fewer, but at
/// least 20.
int consistency_frames(const CameraModel& camera);

/// Of a map, from at most `consistency_frames` of these frames of it, which are unwrapped and
/// filtered once more.
Consistency consistency_of(const RoomMap& map, const std::vector<DualFrequencyFrame>& frames,
                           const SensorModel& sensor, const PipelineOptions& pipeline);

}  // namespace tofmap::app
