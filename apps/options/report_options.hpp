// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap::app {

/// Which pictures a result gets, group `pictures`.
struct PictureOptions {
  int frames = 3;
  int map_size_px = 1200;

  static std::vector<OptionField<PictureOptions>> fields();
};

/// What report.html holds, group `report`.
struct ReportOptions {
  int frames = 12;
  int points = 40000;

  static std::vector<OptionField<ReportOptions>> fields();
};

}  // namespace tofmap::app
