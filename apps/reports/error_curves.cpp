// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/error_curves.hpp"

#include "reports/report_sections.hpp"

#include <algorithm>
#include <limits>

#include <tofmap/visualization/plot.hpp>

namespace tofmap::app {
namespace {

constexpr int plot_width_px = 640;
constexpr int plot_height_px = 400;

using Methods = std::vector<MethodErrors>;

/// The earliest timestamp of all methods, seconds. Infinite if there is none.
double start_s(const Methods& methods) {
  double start_s = std::numeric_limits<double>::infinity();
  for (const MethodErrors& method : methods) {
    if (!method.path.empty()) start_s = std::min(start_s, method.path.front().timestamp_s);
    if (!method.frames.empty()) start_s = std::min(start_s, method.frames.front().timestamp_s);
  }
  return start_s;
}

Plot path_error_plot(const Methods& methods) {
  Plot plot{"path error over time", "time, s", "distance to the true path, m", {}, 0, 0, true};
  for (const MethodErrors& method : methods) {
    PlotLine line{method.name, {}, {}};
    for (const PoseError& pose : method.path) {
      line.x.push_back(pose.timestamp_s - start_s(methods));
      line.y.push_back(pose.error_m);
    }
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  return plot;
}

Plot wrong_wraps_over_time(const Methods& methods) {
  Plot plot{"wrong wraps over time", "time, s", "off by more than half a wavelength, %", {}};
  for (const MethodErrors& method : methods) {
    PlotLine line{method.name, {}, {}};
    for (const UnwrappingRecord& frame : method.frames) {
      if (!frame.score) continue;
      line.x.push_back(frame.timestamp_s - start_s(methods));
      line.y.push_back(frame.score->wrong_wrap_percent);
    }
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  return plot;
}

Plot over_range_plot(const Methods& methods, Plot plot, double ErrorsOverRange::Bin::*value) {
  for (const MethodErrors& method : methods) {
    PlotLine line{method.name, {}, {}};
    for (const ErrorsOverRange::Bin& bin : over_range(method.frames).bins()) {
      line.x.push_back(bin.range_m);
      line.y.push_back(bin.*value);
    }
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace

void add_error_curves(ReportPage& page, const std::vector<MethodErrors>& methods) {
  std::vector<Plot> plots{
      path_error_plot(methods), wrong_wraps_over_time(methods),
      over_range_plot(
          methods,
          {"wrong wraps over range", "true range, m", "off by more than half a wavelength, %", {}},
          &ErrorsOverRange::Bin::wrong_wrap_percent),
      over_range_plot(methods,
                      {"range error over range, without wrong wraps",
                       "true range, m",
                       "RMSE, m",
                       {},
                       0,
                       0,
                       true},
                      &ErrorsOverRange::Bin::range_rmse_m)};
  std::erase_if(plots, [](const Plot& plot) { return plot.lines.empty(); });
  if (plots.empty()) return;
  page.add_heading("Errors over time and over range");
  add_drawn(page, [&] {
    std::vector<PageFigure> figures;
    for (const Plot& plot : plots) {
      figures.push_back({plot_picture(plot, plot_width_px, plot_height_px), plot.title});
    }
    return figures;
  });
}

}  // namespace tofmap::app
