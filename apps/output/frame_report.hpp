// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/acquisition/frame_source.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// A number as JSON. NaN and infinity become null, since JSON has neither.
nlohmann::ordered_json json_number(double value);

/// Index, timestamp and damage of a frame that could not be read.
nlohmann::ordered_json damaged_json(const SourcedFrame& frame);

/// Adds the numbers of removed and corrected pixels of each filter. The numbers of a filter that is
/// applied twice are added up.
void add_filter_counts(nlohmann::ordered_json& frame, const std::vector<FilterCount>& counts);

/// One frame in the report of a map: unwrapping, filtering, tracking and times.
nlohmann::ordered_json frame_json(const FrameRecord& record);

/// Mean times of the stages over the frames that are neither damaged nor repeated.
StageTimes mean_times(const RoomMap& map);

/// Totals and means over the frames of a map.
nlohmann::ordered_json summary_json(const RoomMap& map);

/// The estimated errors of the camera, and remarks about them.
nlohmann::ordered_json errors_json(const ErrorSurvey& survey);

}  // namespace tofmap::app
