// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "console/interruption.hpp"
#include "console/progress.hpp"
#include "input/recording.hpp"
#include "options/options.hpp"
#include "output/calibration_output.hpp"
#include "output/frame_report.hpp"
#include "reports/fixed_pattern_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <tofmap/calibration/fixed_pattern_fit.hpp>
#include <tofmap/calibration/phase_error_fit.hpp>
#include <tofmap/calibration/recording_samples.hpp>
#include <tofmap/calibration/wall_reference.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/image.hpp>
#include <tofmap/core/text.hpp>
#include <tofmap/diagnostics/residual_survey.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {
namespace {

/// With fewer frames, errors of single surfaces do not average out.
constexpr std::size_t some_frames = 5;

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

/// The function that returns the reference ranges of a frame, and tells once of each frame that no
/// wall fills. `source` and `truth` must outlive it.
ReferenceRanges reference_ranges(CalibrationReference reference, const SequenceReader& source,
                                 const RecordedTruth& truth, const ProgramOptions& options) {
  if (reference == CalibrationReference::truth) {
    return [&truth](const Frame& frame) { return truth.range_m(frame.index); };
  }
  if (reference == CalibrationReference::residual) {
    const auto unwrapper = std::make_shared<Unwrapper>(source.sensor(), options.pipeline.unwrap);
    return [unwrapper](const Frame& frame) {
      return std::make_optional(unwrapper->unwrap(frame).image.range_m);
    };
  }
  WallDistances distances_m = read_wall_distances(options.calibration.wall_file);
  check_wall_distances(distances_m, options.calibration.wall_file, source);
  return [distances_m = std::move(distances_m), &source,
          told = std::set<int>{}](const Frame& frame) mutable -> std::optional<ImageF> {
    const auto distance = distances_m.find(frame.index);
    if (distance == distances_m.end()) return std::nullopt;
    auto range_m = wall_range(frame, source.sensor(), distance->second);
    if (!range_m && told.insert(frame.index).second)
      std::fprintf(stderr, "frame %d: left out, since no flat wall fills the image\n", frame.index);
    return range_m;
  };
}

void print_error(const std::string& name, const PhaseError& error, double offset_sigma_m) {
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
  std::printf("%s: %s\n", name.c_str(), joined(parts, ", ").c_str());
}

void print_lines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) std::printf("%s\n", line.c_str());
}

void print_samples(const RecordingSamples& collected, const SensorModel& sensor) {
  std::printf("from %zu pixels of %s\n", collected.samples.front().size(),
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
  for (const ResidualSurvey& residual : survey_residuals(collected.first_frames, sensor)) {
    if (const auto warning = pairing_warning(residual)) print_warnings({*warning});
  }
  if (collected.frames < some_frames) {
    std::printf("warning: with so few frames, errors of single surfaces do not average out\n");
  }
}

/// What the difference of the offsets contains besides them.
const char* remark_on_motion(CalibrationReference reference) {
  switch (reference) {
    case CalibrationReference::residual:
      return "; this includes motion between the two exposures";
    case CalibrationReference::truth:
      return "; if the camera moved, this includes its motion after the exposure of A, to which "
             "the true ranges belong";
    case CalibrationReference::wall:
    case CalibrationReference::best_there_is:
      break;
  }
  return "";
}

/// The errors of a camera, from the comparisons of its first frequency with the others.
struct CameraFit {
  std::vector<std::size_t> others;  ///< RecordingSamples::others
  std::vector<PhaseErrorFit> fits;  ///< for each of `others`
  std::size_t of_first = 0;         ///< the fit that gives the error of the first frequency
};

void print_fit(const CameraFit& fit, CalibrationReference reference) {
  const PhaseErrorFit& first = fit.fits[fit.of_first];
  print_error(frequency_name(0), first.error_a, first.offset_sigma_a_m);
  for (std::size_t i = 0; i < fit.others.size(); ++i) {
    if (fit.others[i] == 0) continue;
    print_error(frequency_name(fit.others[i]), fit.fits[i].error_b, fit.fits[i].offset_sigma_b_m);
  }
  for (std::size_t i = 0; i < fit.others.size(); ++i) {
    if (fit.others[i] == 0) continue;
    const Estimate& offset_m = fit.fits[i].offset_m;
    std::printf("A measures %.1f mm %s than %s (within %.1f mm)%s\n",
                1000 * std::abs(offset_m.value), offset_m.value < 0 ? "less" : "more",
                frequency_name(fit.others[i]).c_str(), 1000 * offset_m.sigma,
                remark_on_motion(reference));
  }
}

/// Throws InputError if the phases have nothing to do with the reference ranges.
void refuse_unrelated(const RecordingSamples& collected, CalibrationReference reference,
                      const SequenceReader& source) {
  constexpr double least_agreement = 0.6;
  const std::vector<RangeSample>& samples = collected.samples.front();
  if (reference == CalibrationReference::residual || samples.empty()) return;
  if (agreement_with_references(samples, source.sensor().modulation) > least_agreement) {
    return;
  }
  throw InputError(source.folder().string() +
                   (reference == CalibrationReference::truth
                        ? ": the true ranges are not those of the phases; does range_truth belong "
                          "to this recording, and are the frequencies right?"
                        : ": the distances of the wall are not those of the phases; do they belong "
                          "to this recording, and are the frequencies right?"));
}

CameraFit fit_samples(const RecordingSamples& collected, CalibrationReference reference,
                      const SequenceReader& source, const PhaseErrorFitOptions& options) {
  const SensorModel& sensor = source.sensor();
  CameraFit fit;
  fit.others = collected.others;
  double least_ratio = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fit.others.size(); ++i) {
    const std::size_t b = fit.others[i];
    const Modulation pair = with_frequencies(sensor, {0, b}).modulation;
    fit.fits.push_back(naming(source.folder().string(), [&] {
      return reference == CalibrationReference::residual
                 ? fit_to_residual(collected.samples[i], pair, options)
                 : fit_to_references(collected.samples[i], pair, options);
    }));
    // The residual tells most of the first frequency if the other one has nearly its wavelength.
    const double ratio = std::abs(std::log(pair.wavelength_m(0) / pair.wavelength_m(1)));
    if (ratio < least_ratio) fit.of_first = i;
    least_ratio = std::min(least_ratio, ratio);
  }
  return fit;
}

/// The errors of all frequencies.
std::vector<PhaseError> errors_of(const CameraFit& fit) {
  std::vector<PhaseError> errors{fit.fits[fit.of_first].error_a};
  for (std::size_t i = 0; i < fit.others.size(); ++i) {
    if (fit.others[i] > 0) errors.push_back(fit.fits[i].error_b);
  }
  return errors;
}

/// Whether the fixed pattern is to be found. Throws UsageError if it is asked for, but there are no
/// known ranges.
bool wants_pattern(FixedPatternOption option, CalibrationReference reference) {
  if (option == FixedPatternOption::off) return false;
  if (reference != CalibrationReference::residual) return true;
  if (option == FixedPatternOption::on) {
    throw UsageError(
        "calibration.fixed_pattern=on needs known ranges (range_truth in the recording, or "
        "calibration.wall_file): the residual shows only differences between the frequencies");
  }
  return false;
}

/// Finds the fixed pattern in the frames that the samples come from. `calibration` has the errors
/// found so far. Empty if that is interrupted, or if the frames are too few without
/// calibration.fixed_pattern=on.
std::vector<PatternEstimate> find_pattern(const SequenceReader& source,
                                          const RecordingSamples& collected,
                                          const ReferenceRanges& ranges,
                                          const CameraCalibration& calibration,
                                          const CalibrationOptions& options, bool quiet) {
  if (options.fixed_pattern != FixedPatternOption::on && collected.frames < some_frames) {
    if (!quiet) {
      std::printf(
          "fixed pattern: not found from fewer than %zu frames, unless "
          "calibration.fixed_pattern=on\n",
          some_frames);
    }
    return {};
  }
  Progress progress("averaging pixels, frame",
                    static_cast<int>(pattern_averagings * collected.frames), quiet);
  int read = 0;
  const auto estimates =
      fit_fixed_pattern(referenced_frames(source, collected.frame_indices, ranges, calibration,
                                          [&] {
                                            progress.show(read++);
                                            return !is_interrupted();
                                          }),
                        source.sensor(), options.max_error_m);
  return is_interrupted() ? std::vector<PatternEstimate>{} : estimates;
}

int run_calibrate(const CalibrateArguments& arguments) {
  ProgramOptions options;
  arguments.common.resolve("calibrate", options);
  const bool quiet = arguments.common.quiet;
  const SequenceReader source(arguments.sequence);
  const RecordedTruth truth(source);
  const CalibrationReference reference = reference_of(options.calibration, source, truth);
  if (reference == CalibrationReference::residual && source.sensor().modulation.count() == 1) {
    throw UsageError("calibration.reference=residual compares frequencies, but " +
                     source.folder().string() +
                     " has one; give known ranges (calibration.wall_file)");
  }
  const bool with_pattern = wants_pattern(options.calibration.fixed_pattern, reference);
  CalibrationOutput out(arguments.out, with_pattern);
  const PhaseErrorFitOptions fit_options{
      .orders = harmonic_orders(options.calibration, reference != CalibrationReference::residual),
      .max_error_m = options.calibration.max_error_m};
  const ReferenceRanges ranges = reference_ranges(reference, source, truth, options);
  const RecordingSamples collected = [&] {
    Progress progress("comparing ranges, frame", *source.frame_count(), quiet);
    return collect_samples(source, ranges, options.calibration.every_frame, [&](int frame) {
      progress.show(frame);
      return !is_interrupted();
    });
  }();
  if (is_interrupted()) return exit_status::interrupted;
  if (reference == CalibrationReference::truth) print_remarks(truth);
  refuse_mostly_damaged(collected.damaged, collected.read, collected.first_damage);
  refuse_unrelated(collected, reference, source);
  const CameraFit fit = fit_samples(collected, reference, source, fit_options);
  if (is_interrupted()) return exit_status::interrupted;
  CameraCalibration calibration;
  const SensorModel& sensor = source.sensor();
  calibration.with =
      CalibratedWith{sensor.camera.width_px, sensor.camera.height_px, sensor.modulation};
  calibration.errors = errors_of(fit);
  if (!quiet) print_fit(fit, reference);
  if (!quiet) print_samples(collected, source.sensor());
  if (with_pattern) {
    const std::vector<PatternEstimate> found =
        find_pattern(source, collected, ranges, calibration, options.calibration, quiet);
    if (is_interrupted()) return exit_status::interrupted;
    const bool with_one_range = options.calibration.fixed_pattern == FixedPatternOption::on;
    calibration.fixed_pattern = stored_pattern(found, with_one_range);
    if (!quiet) print_lines(pattern_lines(found, with_one_range));
  }
  const std::filesystem::path pattern_file =
      out.write(std::move(calibration), "found by " + std::string(name_of(reference)) + " in " +
                                            source.folder().string() + ", " +
                                            std::to_string(collected.samples.front().size()) +
                                            " pixels of " + counted(collected.frames, "frame"));
  if (!quiet) std::printf("calibration: %s\n", arguments.out.c_str());
  if (!quiet && !pattern_file.empty()) std::printf("fixed pattern: %s\n", pattern_file.c_str());
  return exit_status::done;
}

}  // namespace

void add_calibrate_command(CLI::App& program, Outcome& outcome) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* app = program.add_subcommand(
      "calibrate",
      "find a camera's offsets, periodic range errors and fixed pattern from a recording");
  app->add_option("SEQ", arguments->sequence, "folder of the recording")->required();
  app->add_option("--out", arguments->out, "YAML file for the calibration")->required();
  arguments->common.add_to(*app);
  app->callback([arguments, &outcome] { outcome.status = run_calibrate(*arguments); });
}

}  // namespace tofmap::app
