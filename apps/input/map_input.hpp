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

/// The frames that the command `map` reads, from a recording or a device, together with functions
/// that only one of these has.
class MapInput {
 public:
  /// Opens the recording or device. Throws InputError if that fails.
  MapInput(const std::filesystem::path& source, const ProgramOptions& options);

  /// Folder of the recording, or URI of the device.
  const std::string& name() const { return name_; }
  FrameSource& frames();

  /// The recording; null for a device.
  SequenceReader* recording() { return recording_ ? &*recording_ : nullptr; }

  bool is_recording() const { return recording_.has_value(); }

  /// The numbers of a device's late frames and of its unpaired and lost images, as a phrase. Empty
  /// if there are none, and for a recording.
  std::string losses() const { return live_ ? live_->losses() : losses_; }

  /// The survey of the frames so far. A device must not be closed yet.
  SourceSurvey survey();

  /// Closes a device and ends its thread. Its losses and report can still be read. Does nothing for
  /// a recording.
  void close();

  /// LiveInput::report of a device; null for a recording. Valid after close().
  const nlohmann::ordered_json& acquisition() const { return acquisition_; }

  /// A message if the device stopped sending images, else empty. Valid after close().
  const std::string& silence() const { return silence_; }

 private:
  std::string name_;
  UnwrapOptions unwrap_;
  std::optional<SequenceReader> recording_;
  std::optional<LiveInput> live_;
  std::string losses_;
  std::string silence_;
  nlohmann::ordered_json acquisition_;
};

}  // namespace tofmap::app
