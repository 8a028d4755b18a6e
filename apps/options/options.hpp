// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/calibration_options.hpp"
#include "options/evaluation_options.hpp"
#include "options/report_options.hpp"

#include <string>
#include <vector>

#include <tofmap/acquisition/openni2_source.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/filters/view_fusion.hpp>
#include <tofmap/multiway/cloud_registration.hpp>
#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/simulation/tum_recording.hpp>

namespace tofmap::app {

/// Options that every command has.
struct RunOptions {
  int threads = 0;

  static std::vector<OptionField<RunOptions>> fields();
};

/// How frames of a device wait to be worked on.
struct LiveOptions {
  int queue = 8;
  std::string late_frames = "auto";

  static std::vector<OptionField<LiveOptions>> fields();
};

/// The options of all commands; each uses its own groups.
struct ProgramOptions {
  RunOptions run;
  SimulatorOptions simulator;
  TumOptions tum;
  CameraOptions camera;
  DeviceOptions device;
  LiveOptions live;
  CalibrationOptions calibration;
  PipelineOptions pipeline;
  FusionOptions fusion;
  CloudRegistrationOptions cloud_registration;
  EvaluationOptions evaluation;
  PictureOptions pictures;
  ReportOptions report;
};

/// The commands that take options by --set and --config.
const std::vector<std::string>& commands_with_options();

/// The groups of one command, or of all if `command` is empty, bound to `options`, which must
/// outlive the table. Throws UsageError for a command that has no options.
OptionTable option_table(const std::string& command, ProgramOptions& options);

}  // namespace tofmap::app
