// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/imported_recording.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/frame_masks.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/pipeline/room_map.hpp>

namespace tofmap::app {
namespace {

struct ImportArguments {
  std::string format;
  std::filesystem::path path;
  std::filesystem::path out;
  std::filesystem::path p0;
  bool keep_inconsistent = false;
  CommonArguments common;
};

/// What became of the frames of a recording.
struct ImportedFrames {
  int read = 0;
  int written = 0;
  std::vector<std::string> left_out = {};  ///< reasons why frames were not written
  std::int64_t pixels = 0;                 ///< of the frames that were written
  std::int64_t saturated_pixels = 0;       ///< at one of the frequencies
  std::int64_t empty_pixels = 0;           ///< without a return at one of the frequencies
  int damaged_truth = 0;                   ///< true ranges that could not be read
  std::string first_damaged_truth;         ///< why
  float largest_amplitude = 0;

  /// A number of pixels in per cent of all.
  double percent(std::int64_t count) const {
    return 100 * static_cast<double>(count) / static_cast<double>(pixels);
  }
};

/// What the imported frames tell of the description.
std::vector<std::string> warnings_about(const ImportedRecording& recording,
                                        const ImportedFrames& frames) {
  std::vector<std::string> warnings;
  constexpr double most_empty_percent = 95;
  if (frames.percent(frames.empty_pixels) > most_empty_percent) {
    warnings.push_back(
        fmt::format("{:.1f} % of the pixels have no return", frames.percent(frames.empty_pixels)));
  }
  constexpr double most_saturated_percent = 50;
  if (frames.percent(frames.saturated_pixels) > most_saturated_percent) {
    warnings.push_back(fmt::format("{:.1f} % of the pixels are saturated",
                                   frames.percent(frames.saturated_pixels)));
  }
  if (frames.damaged_truth > 0) {
    warnings.push_back(fmt::format("the true ranges of {} are left out; {}",
                                   counted(static_cast<std::size_t>(frames.damaged_truth), "frame"),
                                   frames.first_damaged_truth));
  }
  // Integers that are read as numbers with fractions are mostly below the smallest normal one.
  constexpr float least_amplitude = 1e-20F;
  if (frames.largest_amplitude > 0 && frames.largest_amplitude < least_amplitude) {
    warnings.push_back(
        fmt::format("no amplitude exceeds {:.2g}; are type and byte order those of the data?",
                    frames.largest_amplitude));
  }
  if (!recording.relative_residuals) return warnings;
  constexpr const char* remedy =
      "are step angles and their order, bits, signed, companding, type and byte order those of the "
      "data, and does each step have its dark image?";
  // With four steps and so much noise, the phase has a noise of 0.017 cycles: 13 cm at 20 MHz.
  constexpr double most_residual = 0.15;
  const std::vector<double> residuals = recording.relative_residuals();
  for (std::size_t f = 0; f < residuals.size(); ++f) {
    if (!(residuals[f] > most_residual)) continue;
    warnings.push_back(
        fmt::format("the steps of {} contradict each other by {:.0f} % of the signal, even "
                    "in the brightest quarter of the pixels; {}",
                    frequency_name(f), 100 * residuals[f], remedy));
    return warnings;
  }
  constexpr double most_inconsistent_percent = 5;
  const double inconsistent_percent = frames.percent(recording.inconsistent_pixels());
  if (inconsistent_percent > most_inconsistent_percent) {
    warnings.push_back(fmt::format("{:.1f} % of the pixels are inconsistent; unless much moves, {}",
                                   inconsistent_percent, remedy));
  }
  return warnings;
}

/// The true ranges of a frame. Those that cannot be read are counted.
std::optional<ImageF> true_range_m(const ImportedTruth& truth, const Frame& frame,
                                   ImportedFrames& frames) {
  try {
    return truth.range_m(frame.index, frame.rows(), frame.cols());
  } catch (const InputError& error) {
    if (frames.damaged_truth++ == 0) frames.first_damaged_truth = error.what();
    return std::nullopt;
  }
}

/// Writes one frame and counts its pixels. Returns why the frame cannot be written; empty if it
/// was.
std::string write_frame(const Frame& frame, const ImportedRecording& recording,
                        SequenceWriter& writer, ImportedFrames& frames) {
  try {
    writer.add(frame, {}, true_range_m(recording.truth, frame, frames));
  } catch (const UsageError& error) {
    return error.what();
  }
  frames.pixels += frame.rows() * frame.cols();
  frames.empty_pixels += missing_returns(frame).count();
  frames.saturated_pixels +=
      saturated_pixels(frame, recording.source->sensor().saturation_amplitude).count();
  for (const ImageF& amplitude : frame.amplitudes) {
    frames.largest_amplitude =
        std::fmax(frames.largest_amplitude, amplitude.maxCoeff<Eigen::PropagateNumbers>());
  }
  return "";
}

/// Writes frames until the recording ends or the user interrupts.
ImportedFrames write_frames(const ImportedRecording& recording, SequenceWriter& writer,
                            bool is_quiet) {
  FrameSource& source = *recording.source;
  ImportedFrames frames;
  Progress progress("importing frame", source.frame_count(), is_quiet);
  while (!is_interrupted()) {
    const std::optional<SourcedFrame> sourced = source.next();
    if (!sourced) break;
    ++frames.read;
    const std::string damage =
        sourced->frame ? write_frame(*sourced->frame, recording, writer, frames) : sourced->damage;
    if (!damage.empty()) frames.left_out.push_back(damage);
    progress.show(frames.read);
  }
  frames.written = writer.count();
  return frames;
}

nlohmann::ordered_json report_of(const ImportedRecording& recording, const ImportedFrames& frames,
                                 const std::vector<std::string>& warnings, bool is_whole) {
  nlohmann::ordered_json report = {{"frames", frames.written},
                                   {"interrupted", !is_whole},
                                   {"left_out", frames.left_out},
                                   {"warnings", warnings},
                                   {"pixels", frames.pixels},
                                   {"saturated_pixels", frames.saturated_pixels},
                                   {"empty_pixels", frames.empty_pixels}};
  if (recording.inconsistent_pixels) {
    report["inconsistent_pixels"] = recording.inconsistent_pixels();
  }
  if (recording.relative_residuals) report["relative_residuals"] = recording.relative_residuals();
  return report;
}

void print_summary(const ImportArguments& arguments, const ImportedRecording& recording,
                   const ImportedFrames& frames, const OutputFolder& out) {
  fmt::print("{} of {} of '{}' imported: {}\n", frames.written,
             counted(static_cast<std::size_t>(*recording.source->frame_count()), "frame"),
             arguments.path.string(), out.final_path().string());
  fmt::print("saturated: {:.2f} % of the pixels, without return: {:.2f} %\n",
             frames.percent(frames.saturated_pixels), frames.percent(frames.empty_pixels));
  if (recording.inconsistent_pixels) {
    fmt::print("inconsistent (motion or saturation): {:.2f} % of the pixels, {}\n",
               frames.percent(recording.inconsistent_pixels()),
               arguments.keep_inconsistent ? "kept" : "without return");
  }
  if (!recording.relative_residuals) return;
  const std::vector<double> residuals = recording.relative_residuals();
  for (std::size_t f = 0; f < residuals.size(); ++f) {
    if (std::isnan(residuals[f])) continue;
    fmt::print("residuals of the steps of {}: {:.1f} % of the signal in bright pixels\n",
               frequency_name(f), 100 * residuals[f]);
  }
}

int run_import(const ImportArguments& arguments) {
  ProgramOptions options;
  const OptionTable table = arguments.common.resolve("import", options);
  const ImportedRecording recording =
      open_import({.format = *find_named<ImportFormat>(arguments.format),
                   .path = arguments.path,
                   .p0 = arguments.p0,
                   .keep_inconsistent = arguments.keep_inconsistent});
  OutputFolder out(arguments.out);
  SequenceWriter writer(out.path(), recording.source->sensor());
  const ImportedFrames frames = write_frames(recording, writer, arguments.common.quiet);
  if (!frames.left_out.empty()) {
    refuse_mostly_damaged(static_cast<int>(frames.left_out.size()), frames.read,
                          frames.left_out.front());
  }
  const bool is_whole = frames.read == *recording.source->frame_count();
  if (frames.written == 0) {
    std::fputs("tofmap: interrupted before the first frame; nothing was written\n", stderr);
    return exit_status::interrupted;
  }
  recording.truth.copy_to(out.path());
  std::vector<std::string> warnings = recording.warnings;
  std::ranges::move(warnings_about(recording, frames), std::back_inserter(warnings));
  out.write_text("report.json", json_text(report_of(recording, frames, warnings, is_whole)));
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit(is_whole ? Completeness::whole : Completeness::interrupted);
  if (!frames.left_out.empty()) {
    std::fprintf(stderr, "tofmap: %s left out; the first: %s\n",
                 counted(frames.left_out.size(), "frame").c_str(), frames.left_out.front().c_str());
  }
  if (!arguments.common.quiet) print_summary(arguments, recording, frames, out);
  print_warnings(warnings);
  return is_whole ? exit_status::done : exit_status::interrupted;
}

}  // namespace

void add_import_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* app = program.add_subcommand("import", "make a recording of another program's files");
  app->add_option("FORMAT", arguments->format,
                  "kinect2: packets of a Kinect v2; correlation: arrays of correlation images")
      ->required()
      ->check(CLI::IsMember({"kinect2", "correlation"}));
  app->add_option("PATH", arguments->path,
                  "kinect2: folder of the recording or of its packets; correlation: YAML file that "
                  "describes the images")
      ->required();
  app->add_option("--out", arguments->out, "folder for the recording")->required();
  app->add_option("--p0", arguments->p0,
                  "kinect2: file with the camera's P0 tables, if the recording has none or others");
  app->add_flag("--keep-inconsistent", arguments->keep_inconsistent,
                "correlation: keep phases of pixels whose steps contradict each other");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_import(*arguments); });
}

}  // namespace tofmap::app
