// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

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

/// How many frames tell enough: 60, fewer where images are large, for they are kept, but 20.
int consistency_frames(const CameraModel& camera);

/// Of a map, from at most `consistency_frames` of these frames of it, which are unwrapped and
/// filtered once more.
Consistency consistency_of(const RoomMap& map, const std::vector<DualFrequencyFrame>& frames,
                           const SensorModel& sensor, const PipelineOptions& pipeline);

/// What is more than right maps mostly have, in sentences.
std::vector<std::string> doubts_about(const Consistency& consistency);

nlohmann::ordered_json consistency_json(const Consistency& consistency);

}  // namespace tofmap::app
