// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/report_options.hpp"

namespace tofmap::app {

std::vector<OptionField<PictureOptions>> PictureOptions::fields() {
  using O = PictureOptions;
  return {
      {"frames", &O::frames, 0, 100000, "",
       "number of frames to draw, spread evenly over the recording; 0: none"},
      {"map_size_px", &O::map_size_px, 100, 8000, "px", "longer side of the pictures of the map"},
  };
}

std::vector<OptionField<ReportOptions>> ReportOptions::fields() {
  using O = ReportOptions;
  return {
      {"frames", &O::frames, 0, 200, "",
       "number of frames shown in report.html, spread evenly over the recording"},
      {"points", &O::points, 1000, 500000, "",
       "largest number of points of each map in the 3D view of report.html"},
  };
}

}  // namespace tofmap::app
