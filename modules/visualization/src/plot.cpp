// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/visualization/plot.hpp"

#include "offscreen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlotPoints.h>
#include <vtkRenderer.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

/// Colours that colour-blind readers can tell apart (Okabe and Ito, Color universal design, 2008).
constexpr std::array<Rgb, 7> line_colors{{{0, 114, 178},
                                          {213, 94, 0},
                                          {0, 158, 115},
                                          {204, 121, 167},
                                          {86, 180, 233},
                                          {230, 159, 0},
                                          {0, 0, 0}}};
constexpr std::array line_dashes{vtkPen::SOLID_LINE, vtkPen::DASH_LINE, vtkPen::DASH_DOT_LINE};
constexpr std::array line_marks{vtkPlotPoints::CIRCLE, vtkPlotPoints::SQUARE,
                                vtkPlotPoints::DIAMOND, vtkPlotPoints::CROSS, vtkPlotPoints::PLUS};

vtkSmartPointer<vtkDoubleArray> column(const std::string& name, const std::vector<double>& values) {
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name.c_str());
  for (const double value : values) array->InsertNextValue(value);
  return array;
}

/// Doubles points without a neighbour, since VTK does not draw a line of one point.
PlotLine with_single_points_doubled(const PlotLine& line) {
  const auto is_there = [&](std::size_t i) {
    return i < line.y.size() && std::isfinite(line.x[i]) && std::isfinite(line.y[i]);
  };
  PlotLine out{line.name, {}, {}};
  for (std::size_t i = 0; i < line.y.size(); ++i) {
    const bool is_single = is_there(i) && !is_there(i + 1) && (i == 0 || !is_there(i - 1));
    out.x.insert(out.x.end(), is_single ? 2 : 1, line.x[i]);
    out.y.insert(out.y.end(), is_single ? 2 : 1, line.y[i]);
  }
  return out;
}

void add_line(const PlotLine& line, std::size_t number, vtkChartXY& chart) {
  vtkNew<vtkTable> table;
  table->AddColumn(column("x", line.x));
  table->AddColumn(column(line.name, line.y));
  auto* drawn = vtkPlotPoints::SafeDownCast(chart.AddPlot(vtkChart::LINE));
  drawn->SetInputData(table, 0, 1);
  drawn->SetLabel(line.name);
  const Rgb color = line_colors[number % line_colors.size()];
  drawn->SetColor(color.red, color.green, color.blue, 255);
  drawn->SetWidth(2);
  drawn->GetPen()->SetLineType(line_dashes[number % line_dashes.size()]);
  constexpr std::size_t most_marks = 40;
  drawn->SetMarkerStyle(line.x.size() > most_marks ? vtkPlotPoints::NONE
                                                   : line_marks[number % line_marks.size()]);
  drawn->SetMarkerSize(7);
}

/// Adds a line that is not drawn: VTK leaves out the axes of a chart without lines.
void add_nothing(vtkChartXY& chart) {
  add_line({"", {0, 1}, {0, 1}}, 0, chart);
  auto* unseen = vtkPlotPoints::SafeDownCast(chart.GetPlot(0));
  unseen->SetMarkerStyle(vtkPlotPoints::NONE);
  unseen->GetPen()->SetLineType(vtkPen::NO_PEN);
  chart.SetShowLegend(false);
}

void set_axis(vtkAxis& axis, const std::string& label, double limit) {
  axis.SetTitle(label);
  axis.GetTitleProperties()->SetFontSize(15);
  axis.GetTitleProperties()->BoldOff();
  axis.GetLabelProperties()->SetFontSize(14);
  axis.SetMinimum(0);
  if (limit > 0) axis.SetMaximum(limit);
  axis.SetBehavior(vtkAxis::FIXED);
}

/// The largest finite value of all lines, but at least 0.
double greatest_of(const Plot& plot, std::vector<double> PlotLine::*values) {
  double greatest = 0;
  for (const PlotLine& line : plot.lines) {
    for (const double value : line.*values) {
      if (std::isfinite(value)) greatest = std::max(greatest, value);
    }
  }
  return greatest;
}

/// `limit` if it is above 0, else a tenth beyond the largest value.
double limit_or(double limit, const Plot& plot, std::vector<double> PlotLine::*values) {
  if (limit > 0) return limit;
  const double greatest = greatest_of(plot, values);
  return greatest > 0 ? 1.1 * greatest : 1;
}

/// Makes the y axis logarithmic, over whole decades.
void set_log_axis(vtkAxis& axis, const Plot& plot) {
  double least = std::numeric_limits<double>::infinity();
  for (const PlotLine& line : plot.lines) {
    for (const double value : line.y) {
      if (value > 0) least = std::min(least, value);
    }
  }
  const double greatest = plot.y_limit > 0 ? plot.y_limit : greatest_of(plot, &PlotLine::y);
  const double low = std::isfinite(least) ? std::floor(std::log10(least)) : 0;
  const double high = greatest > 0 ? std::max(low + 1, std::ceil(std::log10(greatest))) : low + 1;
  set_axis(axis, plot.y_label, 0);
  axis.SetRange(std::pow(10, low), std::pow(10, high));
  axis.LogScaleOn();
}

/// A line with NaN where y is not positive.
PlotLine positive(PlotLine line) {
  for (double& value : line.y) {
    if (!(value > 0)) value = std::numeric_limits<double>::quiet_NaN();
  }
  return line;
}

}  // namespace

Picture plot_picture(const Plot& plot, int width_px, int height_px) {
  vtkNew<vtkChartXY> chart;
  chart->SetTitle(plot.title);
  chart->GetTitleProperties()->SetFontSize(18);
  chart->SetShowLegend(true);
  for (std::size_t i = 0; i < plot.lines.size(); ++i) {
    const PlotLine& line = plot.lines[i];
    if (line.x.size() != line.y.size()) {
      throw UsageError("plot: line '" + line.name + "' has different numbers of x and y");
    }
    const PlotLine shown = plot.has_log_y ? positive(line) : line;
    const auto is_there = [](double y) { return std::isfinite(y); };
    if (std::ranges::none_of(shown.y, is_there)) continue;
    add_line(with_single_points_doubled(shown), i, *chart);
  }
  if (chart->GetNumberOfPlots() == 0) add_nothing(*chart);
  set_axis(*chart->GetAxis(vtkAxis::BOTTOM), plot.x_label,
           limit_or(plot.x_limit, plot, &PlotLine::x));
  vtkAxis& left = *chart->GetAxis(vtkAxis::LEFT);
  if (plot.has_log_y) {
    set_log_axis(left, plot);
  } else {
    set_axis(left, plot.y_label, limit_or(plot.y_limit, plot, &PlotLine::y));
  }
  chart->GetLegend()->SetLabelSize(14);
  chart->GetLegend()->SetInline(false);  // beside the lines, not over them
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(chart);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  renderer->AddActor(actor);
  return picture_of(*renderer, width_px, height_px);
}

}  // namespace tofmap
