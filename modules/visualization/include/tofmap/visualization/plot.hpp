// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// A line of a plot.
struct PlotLine {
  std::string name;       ///< for the legend
  std::vector<double> x;  ///< same size as y
  std::vector<double> y;  ///< the line has gaps where y is NaN
};

/// A plot of lines. Linear axes start at 0.
struct Plot {
  std::string title;
  std::string x_label;  ///< quantity and unit
  std::string y_label;  ///< quantity and unit
  std::vector<PlotLine> lines;
  double x_limit = 0;  ///< end of the x axis; 0: a tenth beyond the largest value
  double y_limit = 0;  ///< end of the y axis; 0: a tenth beyond the largest value
  /// Makes the y axis logarithmic, over whole decades. Lines have gaps where y is not positive.
  bool has_log_y = false;
};

/// Draws a plot with a legend. Lines differ in colour (also for colour-blind readers), in dashes
/// and, if they have few points, in markers. Throws UsageError if the x and y of a line differ in
/// number, DrawingError if this machine cannot draw.
Picture plot_picture(const Plot& plot, int width_px, int height_px);

}  // namespace tofmap
