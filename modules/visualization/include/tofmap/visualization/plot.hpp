// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/visualization/picture.hpp>

namespace tofmap {

/// A line of a plot. Where y is NaN it has a gap.
struct PlotLine {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
};

/// Lines over one axis; both start at zero and end at the limits, or where the lines do if these
/// are 0. Labels name quantity and unit. A logarithmic y axis holds all that is positive, and what
/// is not is a gap.
struct Plot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<PlotLine> lines;
  double x_limit = 0;
  double y_limit = 0;
  bool has_log_y = false;
};

/// Draws a plot, with a legend; lines differ in colour (also for eyes that do not tell red from
/// green), in dashes and, if they have few points, in marks. Throws UsageError if a line has not as
/// many x as y, and DrawingError as draw() does.
Picture plot_picture(const Plot& plot, int width_px, int height_px);

}  // namespace tofmap
