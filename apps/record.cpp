// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/live_input.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/json_text.hpp"
#include "output/output_file.hpp"
#include "output/output_folder.hpp"

#include <cstdio>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/text.hpp>

namespace tofmap::app {
namespace {

struct RecordArguments {
  std::string uri;
  std::filesystem::path out;
  std::filesystem::path oni;
  std::string calibration;
  int frames = 0;
  CommonArguments common;
};

/// How many frames of a device were written, and which were not.
struct RecordedFrames {
  int written = 0;
  std::vector<std::string> left_out;  ///< reasons why frames could not be written
};

/// Writes frames until the device ends, the user interrupts, or `arguments.frames` are written.
RecordedFrames write_frames(LiveInput& input, SequenceWriter& writer,
                            const RecordArguments& arguments) {
  RecordedFrames frames;
  Progress progress("recording frame",
                    arguments.frames > 0 ? std::optional(arguments.frames) : std::nullopt,
                    arguments.common.quiet);
  while (const std::optional<SourcedFrame> sourced = input.frames().next()) {
    try {
      if (sourced->frame) writer.add(*sourced->frame);
    } catch (const UsageError& error) {
      frames.left_out.emplace_back(error.what());
    }
    progress.show(writer.count(), input.losses());
  }
  frames.written = writer.count();
  return frames;
}

/// Throws UsageError if the .oni file would be inside the output folder, which is replaced as a
/// whole at the end.
void refuse_inside(const std::filesystem::path& oni, const OutputFolder& out) {
  if (oni.empty()) return;
  const auto file = std::filesystem::weakly_canonical(std::filesystem::absolute(oni));
  const auto inside = file.lexically_relative(out.final_path());
  if (inside.empty() || *inside.begin() == "..") return;
  throw UsageError("--oni " + oni.string() +
                   " is inside the folder of --out; choose another place");
}

/// Plays the .oni file once to check that it is complete, since OpenNI2 does not report write
/// errors.
void check_oni(const std::filesystem::path& file, const DeviceOptions& options, int frames) {
  int played = 0;
  naming("the recording cannot be read back; was the disk full?", [&] {
    OpenNi2Source copy(file.string(), {.options = options});
    while (played < frames && copy.next()) ++played;
  });
  if (played == frames) return;
  throw InputError(file.string() + ": plays only " + std::to_string(played) + " of " +
                   std::to_string(frames) + " frames; was the disk full?");
}

int run_record(const RecordArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("record", options);
  if (!arguments.calibration.empty()) table.set("camera.calibration_file", arguments.calibration);
  OutputFolder out(arguments.out);
  refuse_inside(arguments.oni, out);
  std::optional<OutputFile> oni;
  if (!arguments.oni.empty()) oni.emplace(arguments.oni, [](const auto&) { return false; });
  std::optional<LiveInput> input;
  input.emplace(arguments.uri, options,
                LiveInput::Wanted{oni ? oni->path() : "", arguments.frames});
  RecordedFrames frames;
  if (!is_interrupted()) {
    SequenceWriter writer(out.path(), input->sensor());
    frames = write_frames(*input, writer, arguments);
  }
  const int written = frames.written;
  if (written == 0) {
    if (is_interrupted()) {
      std::fputs("tofmap: interrupted before the first frame; nothing was written\n", stderr);
      return exit_status::interrupted;
    }
    const std::string losses = input->losses();
    throw InputError(arguments.uri + ": delivered no complete frame" +
                     (losses.empty() ? "" : " (" + losses + ")") +
                     "; nothing was written. Are device.layout, device.depth, device.first and the "
                     "frequencies right for the device?");
  }
  const std::vector<std::string> warnings = warnings_about(input->survey());
  const nlohmann::ordered_json report = {{"frames", written},
                                         {"interrupted", is_interrupted()},
                                         {"left_out", frames.left_out},
                                         {"warnings", warnings},
                                         {"acquisition", input->report()}};
  out.write_text("report.json", json_text(report));
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit(is_interrupted() ? Completeness::interrupted : Completeness::whole);
  const std::string losses = input->losses();
  if (!frames.left_out.empty()) {
    std::fprintf(stderr, "tofmap: %s left out; the first: %s\n",
                 counted(frames.left_out.size(), "frame").c_str(), frames.left_out.front().c_str());
  }
  if (!arguments.common.quiet) {
    std::printf("%s of '%s' recorded: %s\n",
                counted(static_cast<std::size_t>(written), "frame").c_str(), arguments.uri.c_str(),
                out.final_path().c_str());
    if (!losses.empty()) std::printf("not recorded: %s; see report.json\n", losses.c_str());
    print_warnings(warnings);
  }
  const std::string silence = input->silence();
  input.reset();  // ends the .oni file
  if (oni) {
    check_oni(oni->path(), options.device, written);
    oni->commit();
  }
  if (!silence.empty()) throw InputError(silence);
  return is_interrupted() ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_record_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* app = program.add_subcommand("record", "record an OpenNI2 device or .oni file");
  app->add_option("URI", arguments->uri,
                  "OpenNI2 device or .oni file; tofmap://SCENE and tofmap:///path/to/recording are "
                  "simulated cameras")
      ->required();
  app->add_option("--out", arguments->out, "folder for the recording")->required();
  app->add_option("--oni", arguments->oni, "also record to this .oni file");
  app->add_option(
      "--calibration", arguments->calibration,
      "calibration of the camera, as 'tofmap calibrate' writes it; applied to the recorded frames");
  app->add_option("--frames", arguments->frames, "stop after this number of frames; 0: no limit")
      ->check(CLI::Range(0, 100'000'000));
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_record(*arguments); });
}

}  // namespace tofmap::app
