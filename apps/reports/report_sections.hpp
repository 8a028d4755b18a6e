// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/report_options.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/visualization/report_page.hpp>

namespace tofmap::app {

/// At most options.frames of the sampled frames, spread evenly, to be stepped through: from what
/// was recorded to what filters left. Wrong wraps are shown where `truth_m` has the true ranges of
/// a frame.
void add_frames(ReportPage& page, const std::vector<SampledFrame>& sample,
                const Modulation& modulation,
                const std::function<std::optional<ImageF>(int index)>& truth_m,
                const ReportOptions& options);

/// What tells without truth whether unwrapping was right, a column a run.
void add_consistency(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<Consistency>& runs);

/// Mean times of the stages, a column a run. Names are as many as runs.
void add_stage_times(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<const RoomMap*>& runs);

/// The options that a run can be repeated with, folded.
void add_options(ReportPage& page, const std::string& options_yaml);

/// Adds what has to be drawn; where there is nothing to draw with, the page says so instead.
void add_drawn(ReportPage& page, const std::function<std::vector<PageFigure>()>& draw);

/// Writes report.html into a result that is in place already. Throws InputError if it cannot be
/// written whole.
void write_page(const std::filesystem::path& result, const ReportPage& page);

}  // namespace tofmap::app
