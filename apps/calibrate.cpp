// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "progress.hpp"
#include "recording.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/phase_error_fit.hpp>
#include <tofmap/acquisition/wall_reference.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {
namespace {

struct CalibrateArguments {
  std::filesystem::path sequence;
  std::filesystem::path out;
  CommonArguments common;
};

/// Where the ranges come from that measured ones are compared with.
enum class Reference : std::uint8_t { truth, wall, beat };

Reference reference_of(const CalibrationOptions& options, const SequenceReader& source) {
  const std::string& wanted = options.reference;
  if (wanted == "wall" && options.wall_file.empty()) {
    throw UsageError("calibration.reference=wall needs calibration.wall_file");
  }
  if (wanted == "wall" || (wanted == "auto" && !options.wall_file.empty())) return Reference::wall;
  const bool has_truth = source.range_truth(0).has_value();
  if (wanted == "truth" && !has_truth) {
    throw InputError(source.folder().string() +
                     ": has no range_truth; calibration.reference=beat needs none");
  }
  if (wanted == "truth" || (wanted == "auto" && has_truth)) return Reference::truth;
  return Reference::beat;
}

const char* name_of(Reference reference) {
  switch (reference) {
    case Reference::truth:
      return "truth";
    case Reference::wall:
      return "wall";
    case Reference::beat:
      return "beat";
  }
  return "";
}

/// Throws InputError if distances are given for frames that the recording does not have.
WallDistances wall_distances(const std::filesystem::path& file, const SequenceReader& source) {
  WallDistances distances_m = read_wall_distances(file);
  const int last = distances_m.rbegin()->first;
  if (last < *source.frame_count()) return distances_m;
  throw InputError(file.string() + ": has a distance for frame " + std::to_string(last) + ", but " +
                   source.folder().string() + " has " + std::to_string(*source.frame_count()) +
                   " frames, counted from 0");
}

/// The ranges of a reference, frame by frame.
class ReferenceRanges {
 public:
  ReferenceRanges(Reference reference, const SequenceReader& source, const ProgramOptions& options)
      : reference_(reference),
        source_(source),
        unwrapper_(source.sensor(), options.pipeline.unwrap) {
    if (reference_ == Reference::wall) {
      wall_distances_m_ = wall_distances(options.calibration.wall_file, source);
    }
  }

  /// Nothing if there is none for the frame.
  std::optional<ImageF> of(const DualFrequencyFrame& frame) {
    if (reference_ == Reference::truth) return source_.range_truth(frame.index);
    if (reference_ == Reference::beat) return unwrapper_.unwrap(frame).image.range_m;
    const auto distance = wall_distances_m_.find(frame.index);
    if (distance == wall_distances_m_.end()) return std::nullopt;
    auto range_m = wall_range(frame, source_.sensor(), distance->second);
    if (!range_m) std::fprintf(stderr, "frame %d: no flat wall fills it; left out\n", frame.index);
    return range_m;
  }

 private:
  Reference reference_;
  const SequenceReader& source_;
  Unwrapper unwrapper_;
  WallDistances wall_distances_m_;
};

/// Pixels of all frames that are looked at, as many as tell enough; fewer if the user ends it.
std::vector<RangePair> collect_pairs(const SequenceReader& source, ReferenceRanges& reference,
                                     int every_frame, bool quiet) {
  constexpr long most_pairs = 2'000'000;
  const CameraModel& camera = source.sensor().camera;
  const int frames = *source.frame_count();
  const long pixels = 1L * camera.width_px * camera.height_px * (1 + (frames - 1) / every_frame);
  const int stride = static_cast<int>(1 + (pixels - 1) / most_pairs);
  std::vector<RangePair> pairs;
  Progress progress("comparing ranges, frame", frames, quiet);
  for (int i = 0; i < frames && !is_interrupted(); i += every_frame) {
    progress.show(i);
    const SourcedFrame sourced = source.read(i);
    if (!sourced.frame) continue;
    const std::optional<ImageF> reference_m = reference.of(*sourced.frame);
    if (!reference_m) continue;
    append_range_pairs(*sourced.frame, source.sensor().modulation, *reference_m, i % stride, stride,
                       pairs);
  }
  return pairs;
}

void print_error(const char* name, const PhaseError& error) {
  std::printf("%s: offset %+.1f mm", name, 1000 * error.offset_m);
  for (const WiggleHarmonic& harmonic : error.harmonics) {
    std::printf(", harmonic %d %.1f mm", harmonic.order,
                1000 * std::hypot(harmonic.cosine_m, harmonic.sine_m));
  }
  std::printf("%s\n", error.harmonics.empty() ? ", no wiggling above its uncertainty" : "");
}

void print_fit(const PhaseErrorFit& fit, Reference reference) {
  print_error("A", fit.error_a);
  print_error("B", fit.error_b);
  std::printf("A measures %+.1f mm more than B%s\n", 1000 * fit.offset_m.value,
              reference == Reference::beat ? "; motion between both images is in it" : "");
}

PhaseErrorFit fit_pairs(const std::vector<RangePair>& pairs, Reference reference,
                        const SequenceReader& source, const PhaseErrorFitOptions& options) {
  const Modulation& modulation = source.sensor().modulation;
  return naming(source.folder().string(), [&] {
    return reference == Reference::beat ? fit_to_beat(pairs, modulation, options)
                                        : fit_to_references(pairs, modulation, options);
  });
}

int run_calibrate(const CalibrateArguments& arguments) {
  ProgramOptions options;
  arguments.common.resolve("calibrate", options);
  const bool quiet = arguments.common.quiet;
  const SequenceReader source(arguments.sequence);
  const Reference reference = reference_of(options.calibration, source);
  OutputFile out(arguments.out, is_calibration);
  const PhaseErrorFitOptions fit_options{
      .orders = harmonic_orders(options.calibration, reference != Reference::beat),
      .max_error_m = options.calibration.max_error_m};
  ReferenceRanges ranges(reference, source, options);
  const std::vector<RangePair> pairs =
      collect_pairs(source, ranges, options.calibration.every_frame, quiet);
  if (is_interrupted()) return exit_status::interrupted;
  const PhaseErrorFit fit = fit_pairs(pairs, reference, source, fit_options);
  CameraCalibration calibration;
  calibration.error_a = fit.error_a;
  calibration.error_b = fit.error_b;
  print_fit(fit, reference);
  write_calibration(out.path(), calibration,
                    "found by " + std::string(name_of(reference)) + " in " +
                        source.folder().string() + ", " + std::to_string(pairs.size()) + " pixels");
  out.commit();
  if (!quiet) std::printf("calibration: %s\n", arguments.out.c_str());
  return exit_status::done;
}

}  // namespace

void add_calibrate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* app = program.add_subcommand(
      "calibrate", "find a camera's offsets and periodic range errors from a recording");
  app->add_option("SEQ", arguments->sequence, "folder of the recording")->required();
  app->add_option("--out", arguments->out, "YAML file for the calibration")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_calibrate(*arguments); });
}

}  // namespace tofmap::app
