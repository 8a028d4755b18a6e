// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/frame_report.hpp"
#include "output/json_text.hpp"
#include "output/output_folder.hpp"
#include "output/pictures.hpp"
#include "output/result_addition.hpp"
#include "output/unwrapped_frame.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>

#include <CLI/CLI.hpp>
#include <omp.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/side_by_side.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>
#include <tofmap/evaluation/recorded_truth.hpp>
#include <tofmap/filters/sliding_fusion.hpp>
#include <tofmap/pipeline/frame_sample.hpp>
#include <tofmap/pipeline/measured_recording.hpp>
#include <tofmap/unwrap/common/unwrap_limits.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct UnwrapArguments {
  RecordingArguments recording;
  std::filesystem::path out;
  std::string method;
  std::filesystem::path poses;
  double min_confidence = 0;
  bool with_filters = false;
  CommonArguments common;
};

/// Limits the range to what 16-bit millimetres can hold, with a margin for noise, if neither the
/// options nor the recording state the largest range of the scene.
void limit_to_image_format(UnwrapOptions& options, const SensorModel& sensor) {
  constexpr double reach_m = 65;
  const bool is_told = options.max_range_m > 0 || sensor.max_range_m > 0;
  if (!is_told && unwrap_limits(sensor, 0).max_range_m > reach_m) options.max_range_m = reach_m;
}

/// Reads a trajectory; throws InputError if it has no pose for any frame of the recording.
Trajectory poses_of(const SequenceReader& source, const std::filesystem::path& file) {
  Trajectory poses = read_trajectory(file);
  if (has_pose_of_a_frame(poses, source.files())) return poses;
  throw InputError(file.string() + ": has no pose within " + std::to_string(max_pose_gap_s) +
                   " s of any frame of " + source.folder().string() +
                   "; does it belong to another recording?");
}

/// The reports of all frames, in order, and how many were damaged or had pixels out of range.
struct UnwrappedRecording {
  Json frames = Json::array();
  int damaged = 0;
  std::string first_damage;
  int out_of_range = 0;         ///< number of pixels out of range
  int frames_out_of_range = 0;  ///< number of frames with such pixels

  void add(const UnwrappedFrame& frame) {
    damaged += frame.damage.empty() ? 0 : 1;
    if (first_damage.empty()) first_damage = frame.damage;
    out_of_range += frame.out_of_range;
    frames_out_of_range += frame.out_of_range > 0 ? 1 : 0;
    frames.push_back(frame.report);
  }

  bool is_empty() const {
    return std::ranges::none_of(
        frames, [](const Json& frame) { return frame.value("valid_pixels", 0) > 0; });
  }
};

/// A frame that is kept in memory for the pictures.
struct KeptFrame {
  std::filesystem::path stem;
  Frame recorded;
  RangeImage unwrapped;
};

/// Unwraps the frames of a recording batch by batch, fuses them if their poses are known, and
/// writes their images.
class FrameWriter {
 public:
  FrameWriter(const SequenceReader& source, const Trajectory& poses,
              const UnwrapArguments& arguments, const ProgramOptions& options,
              const OutputFolder& out)
      : source_(source),
        poses_(poses),
        rays_(pixel_rays(source.sensor().camera)),
        options_{arguments.min_confidence, arguments.with_filters, options.pipeline.filters},
        fusion_(source.sensor().camera, rays_, fusion_options(options, poses)),
        unwrappers_(one_a_thread(Unwrapper(source.sensor(), options.pipeline.unwrap))),
        measured_(source, options.pipeline.unwrap),
        names_(image_names(source)),
        pictured_(spread_indices(*source.frame_count(), options.pictures.frames)),
        out_(out) {}

  /// Unwraps the frames begin … end − 1, and writes those that are ready. `begin` must be the `end`
  /// of the call before.
  void add(int begin, int end) {
    const std::vector<MeasuredSource> sources = measured_.read(begin, end);
    auto frames = side_by_side(end - begin, unwrappers_, [&](Unwrapper& unwrapper, int i) {
      return unwrapped(sources[static_cast<std::size_t>(i)], begin + i, unwrapper);
    });
    for (std::size_t i = 0; i < frames.size(); ++i) {
      UnwrappedFrame& frame = frames[i];
      if (frame.unfiltered) {
        kept_.push_back(
            {frame.name.stem(), *sources[i].sourced.frame, *std::move(frame.unfiltered)});
      }
      std::optional<Pose> pose;
      if (frame.damage.empty()) pose = pose_at(poses_, frame.timestamp_s);
      fusion_.add(std::move(frame.image), pose);
      waiting_.push_back(std::move(frame));
    }
    finish(false);
  }

  /// Fuses and writes the remaining frames, after the last add().
  void finish() { finish(true); }

  const UnwrappedRecording& result() const { return result_; }
  const std::vector<KeptFrame>& kept() const { return kept_; }

 private:
  static FusionOptions fusion_options(const ProgramOptions& options, const Trajectory& poses) {
    FusionOptions fusion = options.fusion;
    if (poses.empty()) fusion.views = 0;
    return fusion;
  }

  UnwrappedFrame unwrapped(const MeasuredSource& source, int index, Unwrapper& unwrapper) const {
    UnwrappedFrameOptions options = options_;
    options.keep_unfiltered = std::ranges::binary_search(pictured_, index);
    UnwrappedFrame frame =
        unwrap_frame(source, source_.sensor().modulation, unwrapper, rays_, options);
    frame.name = names_[static_cast<std::size_t>(index)];
    if (frame.name != image_name(source_.files()[static_cast<std::size_t>(index)])) {
      frame.report["image"] = frame.name.string();
    }
    return frame;
  }

  void finish(bool at_the_end) {
    const int ready = fusion_.ready(at_the_end);
    side_by_side(ready, [&](int i) {
      UnwrappedFrame& frame = waiting_[static_cast<std::size_t>(i)];
      FusedFrame fused = fusion_.fused(i);
      frame.image = std::move(fused.image);
      if (fused.views > 0) add_fusion_counts(frame, fused.views);
      finish_frame(frame);
      if (frame.damage.empty()) write_images(out_.path(), frame);
      return 0;
    });
    fusion_.drop(ready);
    for (int i = 0; i < ready; ++i) {
      result_.add(waiting_.front());
      waiting_.pop_front();
    }
  }

  const SequenceReader& source_;
  const Trajectory& poses_;
  PixelRays rays_;
  UnwrappedFrameOptions options_;
  SlidingFusion fusion_;
  std::vector<Unwrapper> unwrappers_;
  MeasuredRecording measured_;
  std::vector<std::filesystem::path> names_;
  std::vector<int> pictured_;
  const OutputFolder& out_;
  std::deque<UnwrappedFrame> waiting_;  ///< frames that wait for later neighbours to be fused with
  UnwrappedRecording result_;
  std::vector<KeptFrame> kept_;
};

/// Unwraps frames until the recording ends or the user interrupts.
void unwrap_all(FrameWriter& writer, int total, bool quiet) {
  Progress progress("unwrapping frame", total, quiet);
  for (int begin = 0; begin < total && !is_interrupted();) {
    const int end = std::min(total, begin + omp_get_max_threads());
    writer.add(begin, end);
    progress.show(begin = end);
  }
  writer.finish();
}

/// Prints messages on stderr if no pixel has a range, or pixels were out of range.
void say_what_is_missing(const UnwrappedRecording& result) {
  if (result.is_empty()) {
    std::fprintf(stderr, "tofmap: no pixel has a range; 'tofmap info' prints what is wrong\n");
  }
  if (result.out_of_range == 0) return;
  std::fprintf(
      stderr,
      "tofmap: %s in %s had ranges outside the 0.001 m to 65.535 m that images can store; they are "
      "invalid (out_of_range). Surfaces near 0 m, or near the range up to which the "
      "frequencies are unambiguous, have such ranges; unwrap.max_range_m tells how far the scene "
      "reaches\n",
      counted(static_cast<std::size_t>(result.out_of_range), "pixel").c_str(),
      counted(static_cast<std::size_t>(result.frames_out_of_range), "frame").c_str());
}

int run_unwrap(const UnwrapArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("unwrap", options);
  arguments.recording.apply(table);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);
  if (std::isnan(arguments.min_confidence)) throw UsageError("--min-confidence: is not a number");

  const SequenceReader source = open_recording(arguments.recording.sequence, options.camera);
  const Trajectory poses =
      arguments.poses.empty() ? Trajectory{} : poses_of(source, arguments.poses);
  limit_to_image_format(options.pipeline.unwrap, source.sensor());
  OutputFolder out(arguments.out);
  for (const char* name : {"range", "wraps", "confidence", "reason"}) out.make(name);

  const int total = *source.frame_count();
  FrameWriter writer(source, poses, arguments, options, out);
  unwrap_all(writer, total, arguments.common.quiet);
  const UnwrappedRecording& result = writer.result();
  const int done = static_cast<int>(result.frames.size());
  refuse_mostly_damaged(result.damaged, done, result.first_damage);
  const bool interrupted = done < total;
  const Json report = {{"frames", result.frames},
                       {"summary", unwrapping_summary(result.frames, result.damaged, interrupted)}};
  out.write_text("report.json", json_text(report));
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit(interrupted ? Completeness::interrupted : Completeness::whole);
  say_what_is_missing(result);
  const UnwrapOptions& unwrap = options.pipeline.unwrap;
  for (const auto& warning :
       {frequency_warning(source.sensor(), unwrap.max_range_m),
        order_warning(source.sensor().modulation), pair_warning(unwrap, source.sensor())}) {
    if (warning) print_warnings({*warning});
  }
  if (!arguments.common.quiet) {
    std::printf("%d of %d frames unwrapped, %d damaged: %s\n", done - result.damaged, total,
                result.damaged, out.final_path().c_str());
  }
  if (interrupted) return exit_status::interrupted;
  if (options.pictures.frames == 0) return exit_status::done;
  const auto draw = [&](const std::filesystem::path& folder) {
    std::vector<PicturedFrame> frames;
    for (const KeptFrame& kept : writer.kept()) {
      frames.push_back({kept.stem.string(), &kept.recorded, &kept.unwrapped});
    }
    write_frame_pictures(folder, frames, source.sensor(), options.pipeline.unwrap,
                         arguments.common.quiet);
  };
  return add_to_result(out.final_path(), exit_status::done,
                       {{"pictures", [&] { add_pictures(out.final_path(), draw); }}});
}

}  // namespace

void add_unwrap_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<UnwrapArguments>();
  CLI::App* app = program.add_subcommand("unwrap", "make unwrapped range images from a recording");
  arguments->recording.add_to(*app);
  app->add_option("--out", arguments->out, "folder for the result")->required();
  add_method_option(*app, arguments->method);
  app->add_option("--min-confidence", arguments->min_confidence,
                  "invalidate pixels of lower confidence, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  app->add_flag("--filters", arguments->with_filters, "apply the filter chain");
  app->add_option("--poses", arguments->poses,
                  "trajectory (TUM format, as map writes it): fuse each frame with its neighbours");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_unwrap(*arguments); });
}

}  // namespace tofmap::app
