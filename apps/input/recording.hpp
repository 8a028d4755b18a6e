// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/evaluation/recorded_truth.hpp>

namespace CLI {
class App;
}

namespace tofmap::app {

/// A recording as commands take it from the command line: SEQ, and --calibration, which is short
/// for camera.calibration_file.
struct RecordingArguments {
  std::filesystem::path sequence;
  std::string calibration;

  /// `meaning` says what SEQ may be.
  void add_to(CLI::App& command, const std::string& meaning = "folder of the recording");

  /// Puts what was given into the table of a command.
  void apply(OptionTable& table) const;
};

/// What the options say of a camera; nothing if they name no file.
CameraCalibration calibration_of(const CameraOptions& options);

/// What a frame's images in a result are called, by frame: as its phase_a image; if an earlier
/// frame has an image of that name in another folder, with the frame's number.
std::vector<std::filesystem::path> image_names(const SequenceReader& recording);

/// On stdout, a line each.
void print_warnings(const std::vector<std::string>& warnings);

/// Prints what of the truth is damaged on stderr.
void print_remarks(const RecordedTruth& truth);

/// Opens a recording of a calibrated camera.
SequenceReader open_recording(const std::filesystem::path& sequence, const CameraOptions& options);

}  // namespace tofmap::app
