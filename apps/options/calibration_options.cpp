// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "options/calibration_options.hpp"

#include <algorithm>
#include <array>
#include <sstream>

#include <tofmap/core/error.hpp>

namespace tofmap::app {

std::vector<OptionField<CameraOptions>> CameraOptions::fields() {
  return {{"calibration_file", &CameraOptions::calibration_file, 0, 0, "",
           "calibration of the camera, as 'tofmap calibrate' writes it; empty: none"}};
}

std::span<const NamedValue<CalibrationReference>> named_values(CalibrationReference) {
  static constexpr std::array<NamedValue<CalibrationReference>, 4> references{
      {{"auto", CalibrationReference::best_there_is},
       {"truth", CalibrationReference::truth},
       {"wall", CalibrationReference::wall},
       {"residual", CalibrationReference::residual}}};
  return references;
}

std::span<const NamedValue<FixedPatternOption>> named_values(FixedPatternOption) {
  static constexpr std::array<NamedValue<FixedPatternOption>, 3> values{
      {{"auto", FixedPatternOption::if_observable},
       {"off", FixedPatternOption::off},
       {"on", FixedPatternOption::on}}};
  return values;
}

std::vector<OptionField<CalibrationOptions>> CalibrationOptions::fields() {
  using O = CalibrationOptions;
  return {
      {"reference", &O::reference, 0, 0, "",
       "what to compare ranges with. truth: the true ranges of the recording; wall: a flat wall at "
       "known distances; residual: the inter-frequency residual; auto: wall if wall_file is given, "
       "else truth if the recording has it, else residual"},
      {"wall_file", &O::wall_file, 0, 0, "",
       "file with lines 'frame distance': distance of the camera from the wall along its normal, "
       "metres"},
      {"harmonics", &O::harmonics, 0, 0, "",
       "harmonics of the periodic error to fit, whole numbers from 1 to 16 separated by spaces; "
       "empty: 1 2 3 4 8 if ranges are known, 4 8 from the residual, in which motion induces lower "
       "harmonics"},
      {"every_frame", &O::every_frame, 1, 100000, "", "uses every n-th frame"},
      {"max_error_m", &O::max_error_m, 0.001, 1, "m",
       "pixels whose error (or residual) differs from the median by more than this are outliers, "
       "unless noise explains the difference"},
      {"fixed_pattern", &O::fixed_pattern, 0, 0, "",
       "constant range errors of individual pixels. on: found, which needs known ranges (truth or "
       "wall); off: not found; auto: found if ranges are known, there are at least five frames, "
       "and the ranges of pixels differ between them"},
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
      throw UsageError("calibration.harmonics: '" + word + "' is not a whole number from 1 to " +
                       std::to_string(most));
    }
    if (std::ranges::find(orders, order) != orders.end()) {
      throw UsageError("calibration.harmonics: " + word + " is given twice");
    }
    orders.push_back(order);
  }
  return orders;
}

}  // namespace tofmap::app
