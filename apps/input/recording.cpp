// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "input/recording.hpp"

#include <cstdio>
#include <set>

#include <CLI/CLI.hpp>

namespace tofmap::app {

void RecordingArguments::add_to(CLI::App& command, const std::string& meaning) {
  command.add_option("SEQ", sequence, meaning)->required();
  command.add_option("--calibration", calibration,
                     "calibration of the camera, as 'tofmap calibrate' writes it");
}

void RecordingArguments::apply(OptionTable& table) const {
  if (!calibration.empty()) table.set("camera.calibration_file", calibration);
}

CameraCalibration calibration_of(const CameraOptions& options) {
  if (options.calibration_file.empty()) return {};
  return read_calibration(options.calibration_file);
}

std::filesystem::path image_name(const SequenceFrameFiles& files) {
  return files.phases.empty() ? std::filesystem::path() : files.phases.front().filename();
}

std::vector<std::filesystem::path> image_names(const SequenceReader& recording) {
  std::vector<std::filesystem::path> names;
  std::set<std::filesystem::path> taken;
  for (const SequenceFrameFiles& files : recording.files()) {
    std::filesystem::path name = image_name(files);
    const std::string number = "_frame_" + std::to_string(names.size());
    while (!name.empty() && !taken.insert(name).second) {
      name = name.stem().string() + number + name.extension().string();
    }
    names.push_back(std::move(name));
  }
  return names;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
}

void print_remarks(const RecordedTruth& truth) {
  for (const std::string& remark : truth.remarks()) {
    std::fprintf(stderr, "tofmap: %s\n", remark.c_str());
  }
}

SequenceReader open_recording(const std::filesystem::path& sequence, const CameraOptions& options) {
  return SequenceReader(sequence, calibration_of(options));
}

}  // namespace tofmap::app
