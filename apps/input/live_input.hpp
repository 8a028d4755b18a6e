// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "input/watched_source.hpp"
#include "options/options.hpp"

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <tofmap/acquisition/openni2_source.hpp>
#include <tofmap/acquisition/queued_source.hpp>

namespace tofmap::app {

/// An OpenNI2 device or .oni file that a command reads. Frames are received in a separate thread
/// and wait in a queue. Ctrl-C ends the stream.
class LiveInput {
 public:
  /// Settings of a command that are not options.
  struct Wanted {
    std::filesystem::path oni_file = {};  ///< .oni file to record the stream to; empty: none
    int most_frames = 0;                  ///< number of frames after which to stop; 0: no limit
  };

  /// Opens a device or .oni file. Throws as OpenNi2Source does.
  LiveInput(const std::string& uri, const ProgramOptions& options, const Wanted& wanted);

  FrameSource& frames() { return watched_; }
  const SensorModel& sensor() const { return source_.sensor(); }

  /// The numbers of late frames and of unpaired and lost images, as a phrase for a status line.
  /// Empty if there are none.
  std::string losses() const;

  /// URI, losses and the reason for the end, for report.json.
  nlohmann::ordered_json report();

  /// The survey of the frames so far.
  SourceSurvey survey() { return watched_.survey(); }

  /// A message if the device stopped sending images, else empty.
  std::string silence() const;

 private:
  std::string uri_;
  double timeout_s_;
  OpenNi2Source source_;
  QueuedSource queue_;
  WatchedSource watched_;
};

}  // namespace tofmap::app
