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

/// Adds a strip of at most options.frames of the sampled frames, spread evenly, that the reader can
/// step through. It shows each frame from the recorded amplitude to the filtered ranges. Wrong
/// wraps are shown if `truth_m` returns the true ranges of the frame with this index.
void add_frames(ReportPage& page, const std::vector<SampledFrame>& sample,
                const Modulation& modulation,
                const std::function<std::optional<ImageF>(int index)>& truth_m,
                const ReportOptions& options);

/// Adds a table of consistency measures, with one column per run. `names` and `runs` have the same
/// size.
void add_consistency(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<Consistency>& runs);

/// Adds a table of the mean times of the stages, with one column per run. `names` and `runs` have
/// the same size.
void add_stage_times(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<const RoomMap*>& runs);

/// Adds a folded section with all options of the run.
void add_options(ReportPage& page, const std::string& options_yaml);

/// Adds the figures that `draw` returns. If it throws DrawingError, the page gets a text with the
/// reason instead.
void add_drawn(ReportPage& page, const std::function<std::vector<PageFigure>()>& draw);

/// Writes report.html into a result that is already in place. Throws InputError if it cannot be
/// written.
void write_page(const std::filesystem::path& result, const ReportPage& page);

}  // namespace tofmap::app
