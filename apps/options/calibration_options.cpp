// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/calibration_options.hpp"

#include <algorithm>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap::app {

std::vector<OptionField<CameraOptions>> CameraOptions::fields() {
  return {{"calibration_file", &CameraOptions::calibration_file, 0, 0, "",
           "what 'tofmap calibrate' found of the camera; empty: nothing"}};
}

std::vector<OptionField<CalibrationOptions>> CalibrationOptions::fields() {
  using O = CalibrationOptions;
  return {
      {"reference", &O::reference, 0, 0, "",
       "truth: the recording's true ranges; wall: a flat wall at known distances; residual: how "
       "both "
       "frequencies disagree; auto: wall if wall_file is given, else truth where there is any",
       "auto | truth | wall | residual"},
      {"wall_file", &O::wall_file, 0, 0, "",
       "lines 'frame distance', metres from the camera along the wall's normal"},
      {"harmonics", &O::harmonics, 0, 0, "",
       "orders of the periodic error over a wavelength, 1 to 16, with blanks between; empty: 1 2 3 "
       "4 8 against known ranges, 4 8 "
       "by the residual, in which motion feigns lower ones"},
      {"every_frame", &O::every_frame, 1, 100000, "", "every how manieth frame is looked at"},
      {"max_error_m", &O::max_error_m, 0.001, 1, "m",
       "pixels farther off than this, from the middle of all, count as wrong, unless noise "
       "explains it"},
  };
}

std::vector<int> harmonic_orders(const CalibrationOptions& options, bool ranges_are_known) {
  constexpr int most = 16;
  if (options.harmonics.empty()) {
    return ranges_are_known ? std::vector<int>{1, 2, 3, 4, 8} : std::vector<int>{4, 8};
  }
  std::vector<int> orders;
  std::istringstream words(options.harmonics);
  for (std::string word; words >> word;) {
    const bool is_number = word.find_first_not_of("0123456789") == std::string::npos;
    const int order = is_number && word.size() < 3 ? std::stoi(word) : 0;
    if (order < 1 || order > most) {
      throw UsageError("calibration.harmonics: '" + word + "' is no whole number from 1 to " +
                       std::to_string(most));
    }
    if (std::ranges::find(orders, order) != orders.end()) {
      throw UsageError("calibration.harmonics: " + word + " is there twice");
    }
    orders.push_back(order);
  }
  return orders;
}

}  // namespace tofmap::app
