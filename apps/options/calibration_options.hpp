// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <tofmap/core/option_table.hpp>

namespace tofmap::app {

/// The camera of a recording.
struct CameraOptions {
  std::string calibration_file;

  static std::vector<OptionField<CameraOptions>> fields();
};

/// How a camera is calibrated.
struct CalibrationOptions {
  std::string reference = "auto";
  std::string wall_file;
  std::string harmonics;
  int every_frame = 1;
  double max_error_m = 0.15;

  static std::vector<OptionField<CalibrationOptions>> fields();
};

/// The orders of the harmonics that are fitted. Throws UsageError if the option holds something
/// else than whole numbers from 1 to 16.
std::vector<int> harmonic_orders(const CalibrationOptions& options, bool ranges_are_known);

}  // namespace tofmap::app
