// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// JSON has no NaN: what could not be had is null.
nlohmann::ordered_json json_number(double value);

/// {"index", "timestamp", "damage"} of a frame that could not be read.
nlohmann::ordered_json damaged_json(const SourcedFrame& frame);

/// Adds "removed" and "corrected", pixels by filter. A filter that is named twice counts once.
void add_filter_counts(nlohmann::ordered_json& frame, const std::vector<FilterCount>& counts);

/// One frame of a map's report: unwrapping, filtering, tracking and times.
nlohmann::ordered_json frame_json(const FrameRecord& record);

/// Mean times of the stages over the frames that could be read.
StageTimes mean_times(const RoomMap& map);

/// Totals and means over a run.
nlohmann::ordered_json summary_json(const RoomMap& map);

/// What is known of the camera's errors, and what to tell of it.
nlohmann::ordered_json errors_json(const ErrorSurvey& survey);

}  // namespace tofmap::app
