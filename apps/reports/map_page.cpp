// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/map_page.hpp"

#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "output/coverage.hpp"
#include "reports/change_section.hpp"
#include "reports/coverage_section.hpp"
#include "reports/error_curves.hpp"
#include "reports/map_section.hpp"
#include "reports/page_progress.hpp"
#include "reports/report_sections.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <tofmap/core/text.hpp>
#include <tofmap/evaluation/method_run.hpp>
#include <tofmap/visualization/plot.hpp>

namespace tofmap::app {
namespace {

std::optional<ImageF> range_truth(const MapPageSubject& subject, int frame) {
  return subject.truth ? subject.truth->range_m(frame) : std::nullopt;
}

std::string method_name(const MapPageSubject& subject) {
  return std::string(name_of(subject.options.pipeline.unwrap.method));
}

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

/// How the frames of the page were unwrapped.
struct UnwrappedSample {
  std::vector<UnwrappingRecord> frames;
  double moved_percent = 0;  ///< percentage of the ranges with a wrap count above 0
};

UnwrappedSample unwrapped_sample(const MapPageSubject& subject) {
  UnwrappedSample sample;
  double moved = 0;
  double valid = 0;
  for (const SampledFrame& frame : subject.sample) {
    const RangeImage& image = frame.unwrapped.image;
    valid += image.count_valid();
    moved += static_cast<double>((image.reason == 0 && image.wrap_count > 0).count());
    sample.frames.push_back(record_of(frame.unwrapped, frame.recorded.timestamp_s, 0,
                                      range_truth(subject, frame.recorded.index),
                                      subject.sensor.modulation.wavelength_m(0)));
  }
  sample.moved_percent = percent(moved, valid);
  return sample;
}

/// The map that the frames of the page give along the same path without unwrapping.
struct WrappedSample {
  MapCloud map;
  std::vector<UnwrappingRecord> frames;
};

WrappedSample wrapped_sample(const MapPageSubject& subject, bool quiet) {
  PipelineOptions options = subject.options.pipeline;
  options.unwrap.method = UnwrapMethod::none;
  options.map.min_observations = 1;  // the sample has few frames
  FrameMeasurer measurer(subject.sensor, options.unwrap);
  Unwrapper unwrapper(subject.sensor, options.unwrap);
  const PixelRays rays = pixel_rays(subject.sensor.camera);
  SurfaceMap map(options.map);
  WrappedSample sample;
  PageProgress progress(subject.sample.size(), quiet);
  for (const SampledFrame& frame : subject.sample) {
    progress.next_frame();
    const PreparedFrame prepared = prepare_frame(measure_frame(frame.recorded, measurer), unwrapper,
                                                 subject.sensor, rays, options);
    sample.frames.push_back(record_of(prepared.unwrapped, prepared.timestamp_s, 0,
                                      range_truth(subject, prepared.index),
                                      subject.sensor.modulation.wavelength_m(0)));
    const auto pose = pose_at(subject.map.trajectory, prepared.timestamp_s);
    if (pose) map.integrate(*prepared.cloud, *pose);
  }
  sample.map = map.extract();
  return sample;
}

std::string sentence_of(const MapPageSubject& subject, const MapScores& scores,
                        double moved_percent) {
  const RoomMap& map = subject.map;
  std::string text = std::to_string(map.trajectory.size()) + " of " +
                     counted(map.frames.size(), "frame") + " are in this map";
  if (!map.separate_maps.empty()) {
    text += fmt::format(", {} in {}", map.separate(),
                        counted(map.separate_maps.size(), "separate map"));
  }
  text += ". ";
  if (map.interrupted) text += "The run was interrupted. ";
  if (subject.options.pipeline.unwrap.method == UnwrapMethod::none) {
    text += "Nothing was unwrapped. ";
  } else {
    text += fmt::format(
        "Unwrapping moved {:.0f} % of the ranges beyond the non-ambiguity range of frequency A, "
        "{:.2f} m. ",
        moved_percent, subject.sensor.modulation.wavelength_m(0));
  }
  if (scores.surface) {
    text += fmt::format(
        "Against the truth, the map is {:.0f} mm off and shows {:.1f} % of what was seen. ",
        1000 * scores.surface->accuracy_m, scores.surface->completeness_percent);
  }
  if (scores.trajectory) {
    text += fmt::format("The path is {:.0f} mm off.", 1000 * scores.trajectory->ate_rmse_m);
  } else if (!map.interrupted) {
    text += "The truth is not known.";
  }
  return text;
}

/// The warnings about recording and map, and remarks about parts of the truth that could not be
/// read.
std::vector<std::string> warnings_of(const MapPageSubject& subject) {
  std::vector<std::string> warnings = subject.warnings;
  if (subject.truth) std::ranges::move(subject.truth->remarks(), std::back_inserter(warnings));
  return warnings;
}

PageTable summary_table(const RoomMap& map, const MapScores& scores) {
  PageTable table{{"", ""}, {}};
  const auto add = [&](const char* what, const std::string& value) {
    table.rows.push_back({what, value});
  };
  const auto used = std::ranges::count_if(map.loops, [](const Loop& loop) { return loop.is_used; });
  add("frames", std::to_string(map.frames.size()));
  add("registered", std::to_string(map.trajectory.size()));
  if (!map.separate_maps.empty()) add("in separate maps", std::to_string(map.separate()));
  for (const AbsentFrames& absent : absent_frames(map)) {
    add(("in no map, " + absent.why).c_str(), std::to_string(absent.indices.size()));
  }
  add("frames with a degenerate direction, %",
      fmt::format("{:.1f}", percent(map.degenerate(), static_cast<double>(map.frames.size()))));
  add("keyframes", std::to_string(map.keyframes.size()));
  add("loops found, used", std::to_string(map.loops.size()) + ", " + std::to_string(used));
  add("map points", std::to_string(map.surface.size()));
  if (scores.trajectory) {
    add("ATE, m (RMSE)", fmt::format("{:.4f}", scores.trajectory->ate_rmse_m));
    add("ATE, m (greatest)", fmt::format("{:.4f}", scores.trajectory->ate_max_m));
    add("RPE, m per m", fmt::format("{:.4f}", scores.trajectory->rpe_rmse_m_per_m));
    add("RPE, degrees per m", fmt::format("{:.3f}", scores.trajectory->rpe_rmse_deg_per_m));
  }
  if (scores.surface) {
    add("map error, m", fmt::format("{:.4f}", scores.surface->accuracy_m));
    add("map points more than 0.2 m off, %", fmt::format("{:.2f}", scores.surface->far_percent));
    add("completeness (share of the seen surface), %",
        fmt::format("{:.1f}", scores.surface->completeness_percent));
  }
  return table;
}

/// Overlap, inlier ratio and share of kept pixels of each frame over time.
Plot tracking_plot(const RoomMap& map) {
  PlotLine overlap{"overlap with the map", {}, {}};
  PlotLine inliers{"inlier ratio", {}, {}};
  PlotLine kept{"pixels kept by filters", {}, {}};
  for (const FrameRecord& frame : map.frames) {
    if (!frame.is_prepared()) continue;
    const double time_s = frame.timestamp_s - map.frames.front().timestamp_s;
    for (PlotLine* line : {&overlap, &inliers, &kept}) line->x.push_back(time_s);
    overlap.y.push_back(frame.tracking.registration.overlap);
    inliers.y.push_back(frame.tracking.registration.inlier_ratio);
    kept.y.push_back(frame.kept_pixels / std::max(1.0, static_cast<double>(frame.valid_pixels)));
  }
  return {"", "time, s", "share", {overlap, inliers, kept}, 0, 1};
}

/// Adds plots of the errors of the path and of the ranges, with and without unwrapping.
void add_errors(ReportPage& page, const MapPageSubject& subject, const Truth& truth,
                const MapScores& scores, const UnwrappedSample& sample,
                const WrappedSample& wrapped) {
  std::vector<MethodErrors> methods{{method_name(subject), {}, sample.frames}};
  if (scores.trajectory) {
    methods.back().path =
        pose_errors(subject.map.trajectory, truth.poses, scores.trajectory->truth_from_estimate);
  }
  if (!wrapped.frames.empty()) methods.push_back({"none", {}, wrapped.frames});
  add_error_curves(page, methods);
}

/// The map, and the map that the same path gives without unwrapping.
std::vector<ShownMap> shown_maps(const MapPageSubject& subject, const Truth& truth,
                                 const MapScores& scores, const MapCloud& wrapped) {
  std::vector<ShownMap> maps{
      shown_map(name_of_map(subject.options.pipeline.unwrap.method), subject.map, scores)};
  if (wrapped.empty()) return maps;
  ShownMap as_measured = maps.front();
  as_measured.name =
      "the same path, ranges as measured (of " + counted(subject.sample.size(), "frame") + ")";
  as_measured.surface = &wrapped;
  if (scores.surface) {
    as_measured.errors_m =
        map_errors_m(wrapped, *as_measured.truth_from_map, truth.surface, far_error_m);
  }
  maps.push_back(std::move(as_measured));
  return maps;
}

}  // namespace

void write_map_page(const std::filesystem::path& result, const MapPageSubject& subject,
                    bool quiet) {
  const RoomMap& map = subject.map;
  Truth truth;
  if (subject.truth) {
    Progress progress("reading truth, frame", subject.recording->frame_count(), quiet);
    truth = read_truth(*subject.recording, *subject.truth, [&](int index) {
      stop_if_interrupted();
      progress.show(index);
    });
  }
  const MapScores scores = score_of(map, truth);
  const UnwrappedSample sample = unwrapped_sample(subject);
  const bool is_unwrapped = subject.options.pipeline.unwrap.method != UnwrapMethod::none;
  const WrappedSample wrapped = is_unwrapped ? wrapped_sample(subject, quiet) : WrappedSample{};

  ReportPage page("Map of " + subject.source,
                  "tofmap " TOFMAP_VERSION ", method " + method_name(subject));
  MapEvidence evidence =
      evidence_of(map, subject.options.pipeline, subject.consistency, subject.warnings);
  if (scores.surface) evidence.accuracy_m = scores.surface->accuracy_m;
  const Judgement judgement = judge(evidence);
  page.add_verdict(judgement.verdict,
                   sentence_of(subject, scores, sample.moved_percent) + told_reasons(judgement));
  page.add_warnings(warnings_of(subject));
  add_maps(page, shown_maps(subject, truth, scores, wrapped.map), truth.poses,
           subject.options.report);
  add_changes(page, map.surface, map.trajectory, map.changes, subject.recordings);
  add_coverage(page, map);
  add_errors(page, subject, truth, scores, sample, wrapped);
  add_frames(
      page, subject.sample, subject.sensor.modulation,
      [&](int frame) { return range_truth(subject, frame); }, subject.options.report);
  page.add_heading("Figures");
  page.add_table(summary_table(map, scores));
  page.add_heading("Tracking over time");
  add_drawn(page, [&] {
    return std::vector<PageFigure>{
        {plot_picture(tracking_plot(map), 1000, 420), "how well each frame fitted the map"}};
  });
  add_consistency(page, {"map"}, {subject.consistency});
  add_stage_times(page, {"mean"}, {&map});
  add_options(page, subject.options_yaml);
  write_page(result, page);
}

}  // namespace tofmap::app
