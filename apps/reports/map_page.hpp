// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/options.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/evaluation/recorded_truth.hpp>
#include <tofmap/pipeline/frame_sample.hpp>

namespace tofmap::app {

/// The contents of the page of a map.
struct MapPageSubject {
  std::string source;  ///< folder of the recording, or URI of the device
  const RoomMap& map;
  const std::vector<MapRecording>& recordings;  ///< that the map was made from
  const SensorModel& sensor;
  const std::vector<SampledFrame>& sample;  ///< some of the frames of the map
  const SequenceReader* recording;          ///< null for a device
  const RecordedTruth* truth;               ///< of the recording; null for a device
  std::vector<std::string> warnings;
  Consistency consistency;
  const ProgramOptions& options;
  std::string options_yaml;
};

/// Writes report.html into a result that is already in place. The page shows the map, and the map
/// that the same path gives without unwrapping. Throws InputError if it cannot be written,
/// Interrupted after Ctrl-C.
void write_map_page(const std::filesystem::path& result, const MapPageSubject& subject, bool quiet);

}  // namespace tofmap::app
