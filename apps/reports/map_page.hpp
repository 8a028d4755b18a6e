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

/// What the page of a map tells of.
struct MapPageSubject {
  std::string source;  ///< folder of the recording, or device
  const RoomMap& map;
  const SensorModel& sensor;
  const std::vector<SampledFrame>& sample;  ///< of the frames that the map is made of
  const SequenceReader* recording;          ///< for its truth; none of a device
  const RecordedTruth* truth;               ///< of the recording, if there is one
  std::vector<std::string> warnings;
  Consistency consistency;
  const ProgramOptions& options;
  std::string options_yaml;
};

/// Writes report.html into a result that is in place already: what became of the map, and what it
/// would be on the same path with ranges as measured. Throws InputError if it cannot be written,
/// and Interrupted.
void write_map_page(const std::filesystem::path& result, const MapPageSubject& subject, bool quiet);

}  // namespace tofmap::app
