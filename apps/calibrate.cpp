// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "command.hpp"
#include "interruption.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "recording.hpp"

#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>

#include <CLI/CLI.hpp>

#include <tofmap/acquisition/phase_error_fit.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap::app {
namespace {

struct CalibrateArguments {
  std::filesystem::path sequence;
  std::filesystem::path out;
  CommonArguments common;
};

/// One pixel against a range that tells its wraps, and perhaps its error.
struct Sample {
  double phase_a, phase_b;
  double range_a_m, range_b_m;  ///< as measured, with the wraps of the reference
  double reference_m;
};

double unwrapped_m(double phase_cycles, double wavelength_m, double near_m) {
  const double wraps = std::round(near_m / wavelength_m - phase_cycles);
  return wavelength_m * (wraps + phase_cycles);
}

/// All pixels of a frame that have returns and a reference range.
void visit_samples(const DualFrequencyFrame& frame, const Modulation& modulation,
                   const ImageF& reference_m, const std::function<void(const Sample&)>& visit) {
  for (Eigen::Index i = 0; i < reference_m.size(); ++i) {
    const float a = frame.phase_a.data()[i];
    const float b = frame.phase_b.data()[i];
    const float reference = reference_m.data()[i];
    if (std::isnan(a) || std::isnan(b) || std::isnan(reference)) continue;
    visit({a, b, unwrapped_m(a, modulation.wavelength_a_m(), reference),
           unwrapped_m(b, modulation.wavelength_b_m(), reference), reference});
  }
}

/// The frames that are looked at, each with its reference ranges.
class Samples {
 public:
  Samples(const SequenceReader& source, const ProgramOptions& options, bool by_truth)
      : source_(source),
        every_frame_(options.calibration.every_frame),
        by_truth_(by_truth),
        unwrapper_(source.sensor(), options.pipeline.unwrap) {}

  /// Goes through all of them; false if the user ends it.
  bool visit(const std::string& what, bool quiet, const std::function<void(const Sample&)>& visit) {
    Progress progress(what, source_.frame_count(), quiet);
    for (int i = 0; i < *source_.frame_count(); i += every_frame_) {
      progress.show(i);
      if (is_interrupted()) return false;
      const SourcedFrame sourced = source_.read(i);
      if (!sourced.frame) continue;
      const std::optional<ImageF> reference = reference_m(i, *sourced.frame);
      if (!reference) continue;
      visit_samples(*sourced.frame, source_.sensor().modulation, *reference, visit);
    }
    return true;
  }

 private:
  std::optional<ImageF> reference_m(int index, const DualFrequencyFrame& frame) {
    if (by_truth_) return source_.range_truth(index);
    return unwrapper_.unwrap(frame).image.range_m;
  }

  const SequenceReader& source_;
  int every_frame_;
  bool by_truth_;
  Unwrapper unwrapper_;
};

/// The middle of errors, a histogram of which is enough.
class MiddleOf {
 public:
  void add(double error_m) {
    const double place = (error_m + reach_m) / step_m;
    if (place >= 0 && place < static_cast<double>(counts_.size())) {
      ++counts_[static_cast<std::size_t>(place)];
      ++total_;
    }
  }

  double value_m() const {
    long below = 0;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      below += counts_[i];
      if (2 * below >= total_) return (static_cast<double>(i) + 0.5) * step_m - reach_m;
    }
    return 0;
  }

 private:
  static constexpr double reach_m = 5;
  static constexpr double step_m = 0.002;
  std::vector<long> counts_ = std::vector<long>(static_cast<std::size_t>(2 * reach_m / step_m), 0);
  long total_ = 0;
};

void print_error(const char* name, const PhaseError& error) {
  std::printf("%s: offset %+.1f mm", name, 1000 * error.offset_m);
  for (const WiggleHarmonic& harmonic : error.harmonics) {
    std::printf(", harmonic %d %.1f mm", harmonic.order,
                1000 * std::hypot(harmonic.cosine_m, harmonic.sine_m));
  }
  std::printf("%s\n", error.harmonics.empty() ? ", no wiggling above its uncertainty" : "");
}

CameraCalibration by_truth(Samples& samples, const CalibrationOptions& options, bool quiet) {
  MiddleOf middle_a;
  MiddleOf middle_b;
  samples.visit("looking for offsets, frame", quiet, [&](const Sample& sample) {
    middle_a.add(sample.range_a_m - sample.reference_m);
    middle_b.add(sample.range_b_m - sample.reference_m);
  });
  const std::vector<int> orders = harmonic_orders(options, "truth");
  PhaseErrorFit fit_a(orders);
  PhaseErrorFit fit_b(orders);
  const double a_m = middle_a.value_m();
  const double b_m = middle_b.value_m();
  samples.visit("fitting, frame", quiet, [&](const Sample& sample) {
    const double error_a_m = sample.range_a_m - sample.reference_m;
    const double error_b_m = sample.range_b_m - sample.reference_m;
    if (std::abs(error_a_m - a_m) < options.max_error_m) fit_a.add(sample.phase_a, error_a_m);
    if (std::abs(error_b_m - b_m) < options.max_error_m) fit_b.add(sample.phase_b, error_b_m);
  });
  CameraCalibration calibration;
  calibration.error_a = fit_a.solve();
  calibration.error_b = fit_b.solve();
  return calibration;
}

CameraCalibration by_beat(Samples& samples, const Modulation& modulation,
                          const CalibrationOptions& options, bool quiet) {
  MiddleOf middle;
  samples.visit("looking for offsets, frame", quiet,
                [&](const Sample& sample) { middle.add(sample.range_a_m - sample.range_b_m); });
  BeatErrorFit fit(harmonic_orders(options, "beat"), modulation);
  const double middle_m = middle.value_m();
  samples.visit("fitting, frame", quiet, [&](const Sample& sample) {
    const double difference_m = sample.range_a_m - sample.range_b_m;
    if (std::abs(difference_m - middle_m) > options.max_error_m) return;
    fit.add(sample.phase_a, sample.phase_b, difference_m);
  });
  const BeatErrorFit::Result result = fit.solve();
  std::printf("A measures %+.1f mm more than B; motion between both images is in it\n",
              1000 * result.offset_m.value);
  CameraCalibration calibration;
  calibration.error_a = result.error_a;
  calibration.error_b = result.error_b;
  return calibration;
}

int run_calibrate(const CalibrateArguments& arguments) {
  ProgramOptions options;
  arguments.common.resolve("calibrate", options);
  const bool quiet = arguments.common.quiet;
  const SequenceReader source(arguments.sequence);
  const bool has_truth = source.range_truth(0).has_value();
  const std::string& reference = options.calibration.reference;
  if (reference == "truth" && !has_truth) {
    throw InputError(arguments.sequence.string() +
                     ": has no range_truth; calibration.reference=beat needs none");
  }
  const bool truth = reference == "truth" || (reference == "auto" && has_truth);
  Samples samples(source, options, truth);
  const CameraCalibration calibration =
      truth ? by_truth(samples, options.calibration, quiet)
            : by_beat(samples, source.sensor().modulation, options.calibration, quiet);
  if (is_interrupted()) return exit_status::interrupted;
  print_error("A", calibration.error_a);
  print_error("B", calibration.error_b);
  write_calibration(arguments.out, calibration);
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
