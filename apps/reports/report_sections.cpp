// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/report_sections.hpp"

#include "output/frame_report.hpp"
#include "output/result_addition.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/visualization/drawing.hpp>
#include <tofmap/visualization/frame_strip.hpp>

namespace tofmap::app {
namespace {

StagedFrame staged_frame(const SampledFrame& frame, const Modulation& modulation) {
  StagedFrame staged;
  staged.title =
      fmt::format("Frame {}, {:.2f} s", frame.recorded.index, frame.recorded.timestamp_s);
  if (frame.recorded.has_amplitude()) staged.amplitude = frame.recorded.amplitudes.front();
  staged.wrapped_m = frame.recorded.phases[0] * static_cast<float>(modulation.wavelength_m(0));
  staged.unwrapped = frame.unwrapped.image;
  staged.filtered = frame.filtered;
  return staged;
}

}  // namespace

void add_drawn(ReportPage& page, const std::function<std::vector<PageFigure>()>& draw) {
  try {
    page.add_figures(draw());
  } catch (const DrawingError& error) {
    page.add_text(std::string("Not drawn: ") + error.what());
  }
}

void add_frames(ReportPage& page, const std::vector<SampledFrame>& sample,
                const Modulation& modulation,
                const std::function<std::optional<ImageF>(int index)>& truth_m,
                const ReportOptions& options) {
  if (sample.empty() || options.frames == 0) return;
  std::vector<StagedFrame> staged;
  for (const int i : spread_indices(static_cast<int>(sample.size()), options.frames)) {
    const SampledFrame& frame = sample[static_cast<std::size_t>(i)];
    staged.push_back(staged_frame(frame, modulation));
    if (auto truth = truth_m(frame.recorded.index)) staged.back().truth_m = *std::move(truth);
  }
  const FrameStrip strip = frame_strip(staged, modulation.wavelength_m(0));
  page.add_heading("Frames, from measured phases to filtered ranges");
  page.add_text("Use the buttons, the slider or the arrow keys to step through the frames.");
  page.add_strip(strip.frames, strip.legends);
}

void add_consistency(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<Consistency>& runs) {
  PageTable table;
  table.header = {"measure"};
  table.header.insert(table.header.end(), names.begin(), names.end());
  const auto add_row = [&](const char* measure, int decimals, double Consistency::*value) {
    std::vector<std::string> row{measure};
    for (const Consistency& run : runs) {
      row.push_back(std::isfinite(run.*value) ? fmt::format("{:.{}f}", run.*value, decimals) : "-");
    }
    table.rows.push_back(std::move(row));
  };
  add_row("free-space violations, %", 2, &Consistency::contradicted_percent);
  add_row("pixels that fit all frequencies better with another wrap count, %", 2,
          &Consistency::residual_misfit_percent);
  add_row("phase B minus its prediction from A's range, cycles (RMS)", 4,
          &Consistency::residual_rms_cycles);
  add_row("ambiguous pixels, %", 2, &Consistency::ambiguous_percent);
  add_row("thickness of planar surfaces in the map, m (median)", 4,
          &Consistency::plane_thickness_m);
  add_row("disagreement of views about surfaces beyond noise, m (RMS)", 4,
          &Consistency::view_disagreement_m);
  add_row("curl violations per frame (jump, paper, single)", 1,
          &Consistency::curl_violations_per_frame);
  page.add_heading("Consistency, without ground truth");
  page.add_table(table);
}

void add_stage_times(ReportPage& page, const std::vector<std::string>& names,
                     const std::vector<const RoomMap*>& runs) {
  PageTable table;
  table.header = {"stage, ms per frame"};
  table.header.insert(table.header.end(), names.begin(), names.end());
  std::vector<StageTimes> means;
  for (const RoomMap* run : runs) means.push_back(mean_times(*run));
  const auto add_row = [&](const char* stage, const auto& time_of) {
    std::vector<std::string> row{stage};
    for (const StageTimes& mean : means) row.push_back(fmt::format("{:.1f}", time_of(mean)));
    table.rows.push_back(std::move(row));
  };
  for (const auto& [stage, time_ms] : stage_times) add_row(stage, std::mem_fn(time_ms));
  add_row("total", std::mem_fn(&StageTimes::total_ms));
  page.add_heading("Time");
  page.add_table(table);
}

void add_options(ReportPage& page, const std::string& options_yaml) {
  page.add_heading("Options");
  page.add_folded("All options, as a file for --config", options_yaml);
}

void write_page(const std::filesystem::path& result, const ReportPage& page) {
  ResultAddition file(result, "report.html");
  std::ofstream out(file.path(), std::ios::binary);
  out << page.html();
  out.close();
  if (!out) {
    throw InputError((result / "report.html").string() +
                     ": cannot be written; is the disk full, or the folder read-only?");
  }
  file.commit();
}

}  // namespace tofmap::app
