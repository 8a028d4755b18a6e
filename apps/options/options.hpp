// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "options/calibration_options.hpp"
#include "options/evaluation_options.hpp"
#include "options/report_options.hpp"

#include <span>
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

/// Options that every command has, without a group.
struct RunOptions {
  /// Number of threads, 0 … 1024. 0: all. It does not change the result.
  int threads = 0;

  static std::vector<OptionField<RunOptions>> fields();
};

/// What to do with a new frame of a device when the queue is full.
enum class LateFramesOption {
  by_source,  ///< make the source wait if it waits for its reader, as files do; else drop
  drop,       ///< drop the oldest frame
  block,      ///< make the device wait
};
std::span<const NamedValue<LateFramesOption>> named_values(LateFramesOption);

/// How frames of a device wait to be processed, group `live`.
struct LiveOptions {
  /// Number of frames that may wait to be processed, 1 … 10000.
  int queue = 8;

  /// What to do with a new frame when the queue is full.
  LateFramesOption late_frames = LateFramesOption::by_source;

  static std::vector<OptionField<LiveOptions>> fields();
};

/// The options of all commands. Each command uses some of the groups.
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

/// The names of the commands that take options by --set and --config.
const std::vector<std::string>& commands_with_options();

/// A table of the option groups of one command, or of all commands if `command` is empty. It is
/// bound to `options`, which must outlive the table. For `unwrap`, the default filter chain in
/// `options` is replaced. Throws UsageError for a command that has no options.
OptionTable option_table(const std::string& command, ProgramOptions& options);

}  // namespace tofmap::app
