// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap::app {

/// The pictures in a result, group `pictures`.
struct PictureOptions {
  /// Number of frames to draw, 0 … 100000, spread evenly over the recording. 0: none.
  int frames = 3;

  /// Longer side of the pictures of the map, pixels, 100 … 8000.
  int map_size_px = 1200;

  static std::vector<OptionField<PictureOptions>> fields();
};

/// The contents of report.html, group `report`.
struct ReportOptions {
  /// Number of frames shown, 0 … 200, spread evenly over the recording.
  int frames = 12;

  /// Largest number of points of each map in the 3D view, 1000 … 500000.
  int points = 40000;

  static std::vector<OptionField<ReportOptions>> fields();
};

}  // namespace tofmap::app
