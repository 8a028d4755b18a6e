// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "output/calibration_output.hpp"

#include <system_error>

#include <tofmap/core/error.hpp>

namespace tofmap::app {
namespace fs = std::filesystem;

namespace {

/// The file of the pattern that `calibrate` writes beside a calibration.
fs::path pattern_file_of(const fs::path& calibration) {
  return calibration.parent_path() / (calibration.stem().string() + ".fixed_pattern.npy");
}

/// Whether a calibration file names, of all files, the one that `calibrate` writes beside it.
bool names_own_pattern(const fs::path& calibration) {
  const std::string name = fixed_pattern_file_in(calibration);
  return !name.empty() && name == pattern_file_of(calibration).filename();
}

/// Whether a file is a calibration with nothing in it but what `calibrate` writes, so that it may
/// be replaced. True for a calibration file that cannot be read.
bool holds_nothing_else(const fs::path& file) {
  if (!is_calibration(file)) return false;
  if (!fixed_pattern_file_in(file).empty() && !names_own_pattern(file)) return false;
  try {
    const CameraCalibration calibration = read_calibration(file);
    return !calibration.camera && calibration.saturation_amplitude == 0;
  } catch (const InputError&) {
    return true;  // a damaged calibration is of no use
  }
}

}  // namespace

CalibrationOutput::CalibrationOutput(const fs::path& file, bool may_have_pattern)
    : file_(file, holds_nothing_else),
      pattern_file_(pattern_file_of(file_.target())),
      replaces_pattern_(names_own_pattern(file_.target())) {
  if (may_have_pattern) {
    pattern_.emplace(pattern_file_, [this](const fs::path&) { return replaces_pattern_; });
  }
}

fs::path CalibrationOutput::write(CameraCalibration calibration, const std::string& comment) {
  const bool has_pattern = !calibration.fixed_pattern.empty();
  if (has_pattern && !pattern_) {
    throw UsageError("CalibrationOutput: there is a fixed pattern, but none was expected");
  }
  calibration.fixed_pattern_file = has_pattern ? pattern_file_.filename().string() : "";
  write_calibration(file_.path(), calibration, comment);
  if (has_pattern) write_fixed_pattern(pattern_->path(), calibration.fixed_pattern);
  // The pattern is there before a calibration names it.
  if (has_pattern) pattern_->commit();
  file_.commit();
  if (has_pattern) return pattern_file_;
  std::error_code ignored;  // a pattern that no calibration names does no harm
  if (replaces_pattern_) fs::remove(pattern_file_, ignored);
  return {};
}

}  // namespace tofmap::app
