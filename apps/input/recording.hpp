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

/// The command line arguments that name a recording: SEQ, and --calibration, which stands for the
/// option camera.calibration_file.
struct RecordingArguments {
  std::filesystem::path sequence;  ///< folder of the recording
  std::string calibration;         ///< calibration file; empty if none is given

  /// Adds the arguments to a command. `meaning` is the help text of SEQ.
  void add_to(CLI::App& command, const std::string& meaning = "folder of the recording");

  /// Sets camera.calibration_file in the table of a command if --calibration was given.
  void apply(OptionTable& table) const;
};

/// Reads the calibration file that the options name. Empty if they name none. Throws InputError if
/// it cannot be read.
CameraCalibration calibration_of(const CameraOptions& options);

/// The file name of a frame's first phase image; empty for a frame without one.
std::filesystem::path image_name(const SequenceFrameFiles& files);

/// The file name of each frame's images in a result: that of its first phase image. If an earlier
/// frame has one of the same name in another folder, the frame's number is added. Empty for a frame
/// without a phase image.
std::vector<std::filesystem::path> image_names(const SequenceReader& recording);

/// Prints each warning on a line of stdout.
void print_warnings(const std::vector<std::string>& warnings);

/// Prints on stderr which parts of the truth are damaged.
void print_remarks(const RecordedTruth& truth);

/// Opens a recording with the calibration that the options name. Throws InputError if either cannot
/// be read.
SequenceReader open_recording(const std::filesystem::path& sequence, const CameraOptions& options);

}  // namespace tofmap::app
