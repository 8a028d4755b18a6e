// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "output/output_file.hpp"

#include <filesystem>
#include <optional>
#include <string>

#include <tofmap/acquisition/camera_calibration.hpp>

namespace tofmap::app {

/// A calibration file and, if the calibration has a fixed pattern, the file of the pattern beside
/// it: NAME.fixed_pattern.npy beside NAME.yaml. Both appear only when they are complete. An earlier
/// calibration of `tofmap calibrate` is replaced together with its pattern, no other file is.
class CalibrationOutput {
 public:
  /// `may_have_pattern` says whether the file of the pattern may be needed. Throws InputError, with
  /// the path and a remedy, if one of the files cannot be written or exists and is not one that
  /// `calibrate` wrote.
  CalibrationOutput(const std::filesystem::path& file, bool may_have_pattern);

  /// Writes both files and moves them into place; removes the earlier pattern if the calibration
  /// has none. Returns the file of the pattern, empty if there is none. Throws InputError if that
  /// fails; earlier files then stay as they are. Throws UsageError if there is a pattern, but
  /// `may_have_pattern` was false.
  std::filesystem::path write(CameraCalibration calibration, const std::string& comment);

 private:
  OutputFile file_;
  std::filesystem::path pattern_file_;
  bool replaces_pattern_;  ///< the earlier calibration names pattern_file_
  std::optional<OutputFile> pattern_;
};

}  // namespace tofmap::app
