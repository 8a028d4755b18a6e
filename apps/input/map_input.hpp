// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/live_input.hpp"
#include "options/options.hpp"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::app {

/// The frames that `map` makes a map of, from a recording or a device, and what only one of the two
/// can tell about them.
class MapInput {
 public:
  /// Opens the recording or device. Throws InputError if that fails.
  MapInput(const std::filesystem::path& source, const ProgramOptions& options);

  const std::string& name() const { return name_; }
  FrameSource& frames();

  /// The recording; null for a device.
  SequenceReader* recording() { return recording_ ? &*recording_ : nullptr; }

  bool is_recording() const { return recording_.has_value(); }

  /// Frames that came too late or incomplete, as a phrase. Empty if there are none.
  std::string losses() const { return live_ ? live_->losses() : losses_; }

  /// What is suspicious about the frames so far. `camera` is what unwrapping found of the camera's
  /// errors.
  std::vector<std::string> warnings(const CameraErrors& camera);

  /// Ends a device, whose thread watches for Ctrl-C. What it told is kept.
  void close();

  /// What became of the images of a device, and why it ended; null for a recording. After close().
  const nlohmann::ordered_json& acquisition() const { return acquisition_; }

  /// A message if the device stopped sending images, else empty. After close().
  const std::string& silence() const { return silence_; }

 private:
  std::string name_;
  std::optional<SequenceReader> recording_;
  std::optional<LiveInput> live_;
  std::string losses_;
  std::string silence_;
  nlohmann::ordered_json acquisition_;
};

}  // namespace tofmap::app
