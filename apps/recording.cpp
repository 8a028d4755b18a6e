// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "recording.hpp"

#include <CLI/CLI.hpp>

namespace tofmap::app {

void RecordingArguments::add_to(CLI::App& command) {
  command.add_option("SEQ", sequence, "folder of the recording")->required();
  command.add_option("--calibration", calibration, "what 'tofmap calibrate' found of the camera");
}

void RecordingArguments::apply(OptionTable& table) const {
  if (!calibration.empty()) table.set("camera.calibration_file", calibration);
}

SequenceReader open_recording(const std::filesystem::path& sequence, const CameraOptions& options) {
  CameraCalibration calibration;
  if (!options.calibration_file.empty()) calibration = read_calibration(options.calibration_file);
  return SequenceReader(sequence, std::move(calibration));
}

}  // namespace tofmap::app
