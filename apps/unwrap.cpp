// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "frame_report.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <omp.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/filters/filter_chain.hpp>
#include <tofmap/filters/gates.hpp>
#include <tofmap/pipeline/side_by_side.hpp>
#include <tofmap/unwrap/beat.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {
namespace {

using Json = nlohmann::ordered_json;

struct UnwrapArguments {
  std::filesystem::path sequence;
  std::filesystem::path out;
  std::string method;
  double min_confidence = 0;
  bool with_filters = false;
  CommonArguments common;
};

/// 16-bit millimetres, 0 = invalid.
ImageU16 range_mm(const RangeImage& image, const std::string& name) {
  ImageU16 out = ImageU16::Zero(image.rows(), image.cols());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    if (image.reason.data()[i] != 0) continue;
    const double mm = std::round(1000.0 * image.range_m.data()[i]);
    if (mm > 65535) {
      throw InputError(name + ": a range of " + std::to_string(mm / 1000) +
                       " m does not fit the 65.535 m of a range image; set unwrap.max_range_m");
    }
    // A valid range is never written as 0, which would mean invalid.
    out.data()[i] = static_cast<std::uint16_t>(std::max(1.0, mm));
  }
  return out;
}

ImageU16 confidence_u16(const ImageF& confidence) {
  return (confidence.max(0).min(1) * 65535.0F).round().cast<std::uint16_t>();
}

/// Where neither options nor recording tell how far the scene reaches, no farther than 16 bits of
/// millimetres do, with room for the noise.
void limit_to_image_format(UnwrapOptions& options, const SensorModel& sensor) {
  constexpr double reach_m = 65;
  const bool is_told = options.max_range_m > 0 || sensor.max_range_m > 0;
  if (!is_told && beat_limits(sensor, 0).max_range_m > reach_m) options.max_range_m = reach_m;
}

struct UnwrappedFrame {
  Json report;
  bool is_damaged = false;
  std::string damage;
};

/// Unwraps one frame and writes its images; what became of it is in the report.
UnwrappedFrame unwrap_frame(const SequenceReader& source, int index, Unwrapper& unwrapper,
                            const PixelRays& rays, const PipelineOptions& options,
                            const UnwrapArguments& arguments, const std::filesystem::path& out) {
  const SourcedFrame sourced = source.read(index);
  if (!sourced.frame) return {damaged_json(sourced), true, sourced.damage};

  const auto start = std::chrono::steady_clock::now();
  UnwrapResult result = unwrapper.unwrap(*sourced.frame);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  RangeImage image = drop_low_confidence(result.image, arguments.min_confidence);
  Json report = {{"index", index},
                 {"timestamp", sourced.timestamp_s},
                 {"milliseconds", spent.count()},
                 {"iterations", result.iterations},
                 {"converged", result.converged},
                 {"curl_violations", result.curl_violations},
                 {"largest_message_change", result.largest_message_change},
                 {"phase_noise_cycles", result.phase_noise_cycles},
                 {"regions", result.regions},
                 {"ambiguous_pixels", count_reason(result.image, InvalidReason::ambiguous)},
                 {"saturated_pixels", count_reason(result.image, InvalidReason::saturated)},
                 {"valid_pixels", image.count_valid()}};
  if (arguments.with_filters) {
    FilterResult filtered =
        apply_filters(image, *sourced.frame, source.sensor().modulation, rays, options.filters);
    image = std::move(filtered.image);
    add_filter_counts(report, filtered.counts);
  }
  const std::filesystem::path name = source.files()[index].phase_a.filename();
  write_png(out / "range" / name, range_mm(image, name.string()));
  write_png(out / "wraps" / name, image.wrap_count);
  write_png(out / "confidence" / name, confidence_u16(image.confidence));
  write_png(out / "reason" / name, image.reason);
  return {std::move(report), false, ""};
}

Json summary(const Json& frames, int damaged, bool interrupted) {
  double milliseconds = 0;
  double iterations = 0;
  int converged = 0;
  int read = 0;
  for (const Json& frame : frames) {
    if (frame.contains("damage")) continue;
    ++read;
    milliseconds += frame["milliseconds"].get<double>();
    iterations += frame["iterations"].get<double>();
    converged += frame["converged"].get<bool>() ? 1 : 0;
  }
  const double count = std::max(1, read);
  return {{"frames", frames.size()},
          {"damaged", damaged},
          {"interrupted", interrupted},
          {"converged", converged},
          {"milliseconds_per_frame", milliseconds / count},
          {"iterations_per_frame", iterations / count}};
}

int run_unwrap(const UnwrapArguments& arguments) {
  ProgramOptions options;
  OptionTable table = arguments.common.resolve("unwrap", options);
  if (!arguments.method.empty()) table.set("unwrap.method", arguments.method);

  const SequenceReader source(arguments.sequence);
  limit_to_image_format(options.pipeline.unwrap, source.sensor());
  OutputFolder out(arguments.out);
  for (const char* name : {"range", "wraps", "confidence", "reason"}) out.make(name);

  const PixelRays rays = pixel_rays(source.sensor().camera);
  auto unwrappers = one_a_thread(Unwrapper(source.sensor(), options.pipeline.unwrap));
  const int total = *source.frame_count();
  Json frames = Json::array();
  int damaged = 0;
  std::string first_damage;
  {
    Progress progress("unwrapping frame", total, arguments.common.quiet);
    for (int begin = 0; begin < total && !is_interrupted();) {
      const int end = std::min(total, begin + omp_get_max_threads());
      const auto unwrap_one = [&](Unwrapper& unwrapper, int i) {
        return unwrap_frame(source, begin + i, unwrapper, rays, options.pipeline, arguments,
                            out.path());
      };
      for (UnwrappedFrame& frame : side_by_side(end - begin, unwrappers, unwrap_one)) {
        damaged += frame.is_damaged ? 1 : 0;
        if (first_damage.empty()) first_damage = frame.damage;
        frames.push_back(std::move(frame.report));
      }
      progress.show(begin = end);
    }
  }
  refuse_mostly_damaged(damaged, static_cast<int>(frames.size()), first_damage);
  const bool interrupted = static_cast<int>(frames.size()) < total;
  const Json report = {{"frames", frames}, {"summary", summary(frames, damaged, interrupted)}};
  out.write_text("report.json", report.dump(1) + "\n");
  out.write_text("options.yaml", table.to_yaml(false));
  out.commit();
  if (!arguments.common.quiet) {
    std::printf("%zu of %d frames unwrapped, %d damaged: %s\n", frames.size(), total, damaged,
                out.final_path().c_str());
  }
  if (!interrupted && options.pictures.frames > 0) {
    add_pictures(out.final_path(), [&](const std::filesystem::path& folder) {
      write_frame_pictures(folder, source, options.pipeline.unwrap, options.pictures);
    });
  }
  return interrupted ? exit_status::interrupted : exit_status::done;
}

}  // namespace

void add_unwrap_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<UnwrapArguments>();
  CLI::App* app = program.add_subcommand("unwrap", "make unwrapped range images of a recording");
  app->add_option("SEQ", arguments->sequence, "folder of the recording")->required();
  app->add_option("--out", arguments->out, "folder for the result")->required();
  app->add_option("--method", arguments->method, "how to unwrap: " + unwrap_method_names(", "));
  app->add_option("--min-confidence", arguments->min_confidence,
                  "pixels less sure than this become invalid")
      ->check(CLI::Range(0.0, 1.0));
  app->add_flag("--filters", arguments->with_filters, "apply the filter chain");
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_unwrap(*arguments); });
}

}  // namespace tofmap::app
