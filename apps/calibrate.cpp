// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/frame_report.hpp"
#include "output/output_file.hpp"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/calibration/phase_error_fit.hpp>
#include <tofmap/calibration/wall_reference.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {
namespace {

struct CalibrateArguments {
  std::filesystem::path sequence;
  std::filesystem::path out;
  CommonArguments common;
};

/// What to compare with, never `best_there_is`. Throws UsageError or InputError if what the options
/// name is not there.
CalibrationReference reference_of(const CalibrationOptions& options, const SequenceReader& source,
                                  const RecordedTruth& truth) {
  const CalibrationReference wanted = options.reference;
  if (wanted == CalibrationReference::wall && options.wall_file.empty()) {
    throw UsageError("calibration.reference=wall needs calibration.wall_file");
  }
  if (wanted == CalibrationReference::truth && !truth.has_ranges()) {
    throw InputError(source.folder().string() +
                     ": has no range_truth; calibration.reference=residual needs none");
  }
  if (wanted != CalibrationReference::best_there_is) return wanted;
  if (!options.wall_file.empty()) return CalibrationReference::wall;
  return truth.has_ranges() ? CalibrationReference::truth : CalibrationReference::residual;
}

/// Throws InputError if distances are given for frames that the recording does not have.
WallDistances wall_distances(const std::filesystem::path& file, const SequenceReader& source) {
  WallDistances distances_m = read_wall_distances(file);
  constexpr double farthest_m = 100;  // no wall fills an image from there
  for (const auto& [frame, distance_m] : distances_m) {
    if (distance_m <= farthest_m) continue;
    throw InputError(file.string() +
                     fmt::format(": has a wall at {:g} m in frame {}; are its distances metres?",
                                 distance_m, frame));
  }
  const int last = distances_m.rbegin()->first;
  if (last < *source.frame_count()) return distances_m;
  throw InputError(file.string() + ": has a distance for frame " + std::to_string(last) + ", but " +
                   source.folder().string() + " has " + std::to_string(*source.frame_count()) +
                   " frames, counted from 0");
}

/// The reference ranges of each frame.
class ReferenceRanges {
 public:
  ReferenceRanges(CalibrationReference reference, const SequenceReader& source,
                  const RecordedTruth& truth, const ProgramOptions& options)
      : reference_(reference),
        source_(source),
        truth_(truth),
        unwrapper_(source.sensor(), options.pipeline.unwrap) {
    if (reference_ == CalibrationReference::wall) {
      wall_distances_m_ = wall_distances(options.calibration.wall_file, source);
    }
  }

  /// The reference range of each pixel, metres. Empty if the frame has no reference.
  std::optional<ImageF> of(const DualFrequencyFrame& frame) {
    if (reference_ == CalibrationReference::truth) return truth_.range_m(frame.index);
    if (reference_ == CalibrationReference::residual) return unwrapper_.unwrap(frame).image.range_m;
    const auto distance = wall_distances_m_.find(frame.index);
    if (distance == wall_distances_m_.end()) return std::nullopt;
    auto range_m = wall_range(frame, source_.sensor(), distance->second);
    if (!range_m)
      std::fprintf(stderr, "frame %d: left out, since no flat wall fills the image\n", frame.index);
    return range_m;
  }

 private:
  CalibrationReference reference_;
  const SequenceReader& source_;
  const RecordedTruth& truth_;
  Unwrapper unwrapper_;
  WallDistances wall_distances_m_;
};

/// Pixel samples of a recording, and how many of its frames could be used.
struct CollectedSamples {
  std::vector<RangeSample> samples;
  std::size_t frames = 0;                 ///< number of frames that samples were taken from
  std::vector<DualFrequencyFrame> first;  ///< the first few of these frames
  int read = 0;                           ///< number of frames that were tried, damaged or not
  int damaged = 0;                        ///< number of frames that could not be read
  std::string first_damage;               ///< why the first of them could not be read
  std::size_t repeated = 0;               ///< frames left out because they repeat the one before
};

/// Takes at most about two million samples, spread evenly over frames and pixels. Ends early if the
/// user interrupts it.
CollectedSamples collect_samples(const SequenceReader& source, ReferenceRanges& reference,
                                 int every_frame, bool quiet) {
  constexpr long most_samples = 2'000'000;
  const CameraModel& camera = source.sensor().camera;
  const int frames = *source.frame_count();
  const long pixels = 1L * camera.width_px * camera.height_px * (1 + (frames - 1) / every_frame);
  const int stride = static_cast<int>(1 + (pixels - 1) / most_samples);
  CollectedSamples collected;
  ImageF last_phase;
  Progress progress("comparing ranges, frame", frames, quiet);
  for (int i = 0; i < frames && !is_interrupted(); i += every_frame) {
    progress.show(i);
    const SourcedFrame sourced = source.read(i);
    ++collected.read;
    if (!sourced.frame) {
      if (collected.first_damage.empty()) collected.first_damage = sourced.damage;
      ++collected.damaged;
      continue;
    }
    const bool is_repeated = same_values(sourced.frame->phase_a, last_phase);
    last_phase = sourced.frame->phase_a;
    collected.repeated += is_repeated ? 1 : 0;
    if (is_repeated) continue;
    const std::optional<ImageF> reference_m = reference.of(*sourced.frame);
    if (!reference_m) continue;
    append_range_samples(*sourced.frame, source.sensor(), *reference_m, i % stride, stride,
                         collected.samples);
    ++collected.frames;
    constexpr std::size_t enough = 12;
    if (collected.first.size() < enough) collected.first.push_back(*sourced.frame);
  }
  return collected;
}

void print_error(const char* name, const PhaseError& error, double offset_sigma_m) {
  std::vector<std::string> parts;
  if (offset_sigma_m > 0) {
    parts.push_back(fmt::format("offset {:+.1f} mm (within {:.1f} mm)", 1000 * error.offset_m,
                                1000 * offset_sigma_m));
  }
  for (const WiggleHarmonic& harmonic : error.harmonics) {
    parts.push_back(fmt::format("harmonic {} {:.1f} mm", harmonic.order,
                                1000 * std::hypot(harmonic.cosine_m, harmonic.sine_m)));
  }
  if (error.harmonics.empty()) parts.emplace_back("no periodic error above its uncertainty");
  std::printf("%s: %s\n", name, joined(parts, ", ").c_str());
}

void print_samples(const CollectedSamples& collected, const SensorModel& sensor) {
  std::printf("from %zu pixels of %s\n", collected.samples.size(),
              counted(collected.frames, "frame").c_str());
  if (collected.damaged > 0) {
    std::printf("warning: %d of %s were damaged, the first: %s\n", collected.damaged,
                counted(static_cast<std::size_t>(collected.read), "frame").c_str(),
                collected.first_damage.c_str());
  }
  if (collected.repeated > 0) {
    std::printf("warning: %s left out for repeating the frame before\n",
                counted(collected.repeated, "frame").c_str());
  }
  const std::optional<ResidualSurvey> residual = survey_residual(collected.first, sensor);
  if (const auto warning = residual ? pairing_warning(*residual) : std::nullopt)
    print_warnings({*warning});
  constexpr std::size_t some = 5;
  if (collected.frames < some) {
    std::printf("warning: with so few frames, errors of single surfaces do not average out\n");
  }
}

void print_fit(const PhaseErrorFit& fit, CalibrationReference reference) {
  print_error("A", fit.error_a, fit.offset_sigma_a_m);
  print_error("B", fit.error_b, fit.offset_sigma_b_m);
  std::printf("A measures %.1f mm %s than B (within %.1f mm)%s\n",
              1000 * std::abs(fit.offset_m.value), fit.offset_m.value < 0 ? "less" : "more",
              1000 * fit.offset_m.sigma,
              reference == CalibrationReference::residual
                  ? "; this includes motion between the two exposures"
                  : "");
}

PhaseErrorFit fit_samples(const std::vector<RangeSample>& samples, CalibrationReference reference,
                          const SequenceReader& source, const PhaseErrorFitOptions& options) {
  const Modulation& modulation = source.sensor().modulation;
  return naming(source.folder().string(), [&] {
    return reference == CalibrationReference::residual
               ? fit_to_residual(samples, modulation, options)
               : fit_to_references(samples, modulation, options);
  });
}

/// Whether a file is a calibration with nothing in it but what `calibrate` writes, so that it may
/// be replaced. True for a calibration file that cannot be read.
bool holds_nothing_else(const std::filesystem::path& file) {
  if (!is_calibration(file)) return false;
  try {
    const CameraCalibration calibration = read_calibration(file);
    return !calibration.camera && calibration.saturation_amplitude == 0;
  } catch (const InputError&) {
    return true;  // a damaged calibration is of no use
  }
}

int run_calibrate(const CalibrateArguments& arguments) {
  ProgramOptions options;
  arguments.common.resolve("calibrate", options);
  const bool quiet = arguments.common.quiet;
  const SequenceReader source(arguments.sequence);
  const RecordedTruth truth(source);
  const CalibrationReference reference = reference_of(options.calibration, source, truth);
  OutputFile out(arguments.out, holds_nothing_else);
  const PhaseErrorFitOptions fit_options{
      .orders = harmonic_orders(options.calibration, reference != CalibrationReference::residual),
      .max_error_m = options.calibration.max_error_m};
  ReferenceRanges ranges(reference, source, truth, options);
  const CollectedSamples collected =
      collect_samples(source, ranges, options.calibration.every_frame, quiet);
  if (is_interrupted()) return exit_status::interrupted;
  if (reference == CalibrationReference::truth) print_remarks(truth);
  refuse_mostly_damaged(collected.damaged, collected.read, collected.first_damage);
  const PhaseErrorFit fit = fit_samples(collected.samples, reference, source, fit_options);
  if (is_interrupted()) return exit_status::interrupted;
  CameraCalibration calibration;
  const SensorModel& sensor = source.sensor();
  calibration.with =
      CalibratedWith{sensor.camera.width_px, sensor.camera.height_px, sensor.modulation};
  calibration.error_a = fit.error_a;
  calibration.error_b = fit.error_b;
  if (!quiet) print_fit(fit, reference);
  if (!quiet) print_samples(collected, source.sensor());
  write_calibration(out.path(), calibration,
                    "found by " + std::string(name_of(reference)) + " in " +
                        source.folder().string() + ", " + std::to_string(collected.samples.size()) +
                        " pixels of " + counted(collected.frames, "frame"));
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
