// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include <tofmap/calibration/phase_error_fit.hpp>
#include <tofmap/core/option_table.hpp>

namespace tofmap::app {

/// The camera of a recording or device, group `camera`.
struct CameraOptions {
  /// Calibration of the camera, as `tofmap calibrate` writes it. Empty: none.
  std::string calibration_file;

  static std::vector<OptionField<CameraOptions>> fields();
};

/// What `calibrate` compares ranges with.
enum class CalibrationReference {
  best_there_is,  ///< wall if wall_file is given, else truth if the recording has it, else residual
  truth,          ///< the true ranges of the recording
  wall,           ///< a flat wall at known distances
  residual,       ///< the inter-frequency residual
};
std::span<const NamedValue<CalibrationReference>> named_values(CalibrationReference);

/// Whether `calibrate` finds the range errors of individual pixels.
enum class FixedPatternOption {
  if_observable,  ///< from known ranges, if frames and ranges differ enough to average out the rest
  off,            ///< never
  on,             ///< always; an error if ranges are not known
};
std::span<const NamedValue<FixedPatternOption>> named_values(FixedPatternOption);

/// How `calibrate` fits the errors of a camera, group `calibration`.
struct CalibrationOptions {
  /// What ranges are compared with.
  CalibrationReference reference = CalibrationReference::best_there_is;

  /// File with lines "frame distance": the distance of the camera from the wall along its normal,
  /// metres. Needed for reference "wall".
  std::string wall_file;

  /// Harmonics of the periodic error to fit, whole numbers from 1 to 16 separated by spaces. Empty:
  /// the default of harmonic_orders().
  std::string harmonics;

  /// Uses every n-th frame, 1 … 100000.
  int every_frame = 1;

  /// Pixels whose error (for reference "residual": whose residual) differs from the median by more
  /// than this are outliers, unless noise explains the difference. Metres, 0.001 … 1.
  double max_error_m = PhaseErrorFitOptions{}.max_error_m;

  /// Whether the constant errors of individual pixels are found as well.
  FixedPatternOption fixed_pattern = FixedPatternOption::if_observable;

  static std::vector<OptionField<CalibrationOptions>> fields();
};

/// The orders of the harmonics to fit: those of the option or, if it is empty, 1, 2, 3, 4 and 8 if
/// true ranges are known, and 4 and 8 otherwise. Throws UsageError if the option contains anything
/// but different whole numbers from 1 to 16.
std::vector<int> harmonic_orders(const CalibrationOptions& options, bool ranges_are_known);

}  // namespace tofmap::app
