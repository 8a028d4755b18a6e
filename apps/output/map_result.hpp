// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "console/failure.hpp"
#include "options/options.hpp"
#include "output/map_file.hpp"
#include "output/output_folder.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <tofmap/diagnostics/consistency.hpp>
#include <tofmap/diagnostics/map_verdict.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap::app {

/// What the user wants of the result of a run.
struct MapOutputChoices {
  std::filesystem::path onto = {};  ///< the finished map that is extended; empty: none
  bool has_start = false;           ///< the user says where in it the camera begins
  bool pcd = false;                 ///< map.pcd as well
  bool even_if_worse = false;       ///< an extended map that has a worse verdict than before
  bool resume = false;              ///< that --resume was given, so that an interrupted run goes on
  bool quiet = false;               ///< print nothing
};

/// What is needed to write the result of a run besides the map itself.
struct MapOutput {
  MapOutputChoices choices;
  const ProgramOptions& options;
  std::string options_yaml;
  SensorModel sensor;
  FrameSample sample;
  std::vector<MapRecording> recordings = {};  ///< that the map was made from
  SourceSurvey survey = {};                   ///< of the recording or device
  std::vector<std::string> warnings = {};     ///< about the recording, then about the map
  nlohmann::ordered_json acquisition = {};    ///< report of a device; null for a recording
  std::string losses = {};                    ///< MapInput::losses()
  Failures failures = {};                     ///< failures of optional parts
};

/// A map, its consistency measures, and the verdict on it without ground truth.
struct FinishedMap {
  RoomMap map;
  Consistency consistency;
  Judgement judgement = {};
  bool is_taken_back = false;  ///< the map that was extended stays as it was
};

/// Finishes the map, writes the result and moves it into place. Sets the warnings of `output`.
/// Throws InputError if there is no map to write, or if no frame was found in the map that is
/// extended. If writing fails after the map and the path were written, these are kept, and the
/// message says where.
FinishedMap finish_map(MapRun& run, MapFile& file, OutputFolder& out, MapOutput& output);

}  // namespace tofmap::app
