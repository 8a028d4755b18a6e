// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Methods of unwrapping against scenes, noise and pairs of frequencies, as tables in Markdown:
//
//     bench_unwrap_accuracy [--divide N] [--departures] [SEQ …]
//
// The recordings are simulated; more can be named, with range_truth/. N divides the number of
// frames. With --departures the tables are of what sets `jump` apart from the paper, instead.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/unwrap/unwrap.hpp>

// Inner parts of the module, to leave out one at a time.
#include "jump.hpp"

namespace tofmap {
namespace {

struct Case {
  std::string name;
  SensorModel sensor;
  std::vector<DualFrequencyFrame> frames;
  std::vector<ImageF> truth_m;
};

/// What became of all frames of a case.
struct Score {
  double wrong_percent = 0;  ///< mean over frames
  double worst_percent = 0;
  double sure_wrong_percent = 0;  ///< among the most confident 90 % of each frame
  double coverage_percent = 0;
  double calibration_error_percent = 0;
  double range_rmse_m = 0;       ///< of right counts, mean over frames
  double converged_percent = 0;  ///< frames without curls, of methods of phase jumps
  double milliseconds = 0;
};

constexpr std::size_t bins = 20;

/// Shares of right counts against confidences.
struct Calibration {
  std::array<double, bins> confidence{};
  std::array<double, bins> right{};
  double all = 0;

  void add(float value, bool is_right) {
    const auto bin = std::min(static_cast<std::size_t>(value * bins), bins - 1);
    confidence[bin] += value;
    right[bin] += is_right ? 1 : 0;
    all += 1;
  }

  double error_percent() const {
    double sum = 0;
    for (std::size_t b = 0; b < bins; ++b) sum += std::abs(confidence[b] - right[b]);
    return all > 0 ? 100 * sum / all : 0;
  }
};

/// Adds one frame to the sums of `score`.
void add_frame(const DualFrequencyFrame& frame, const RangeImage& image, const ImageF& truth_m,
               double wavelength_m, Score& score, Calibration& calibration) {
  struct Pixel {
    float confidence;
    bool is_wrong;
  };
  std::vector<Pixel> pixels;
  double returns = 0;
  double squares = 0;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const bool has_return = !std::isnan(frame.phase_a.data()[i] + frame.phase_b.data()[i]);
    if (!has_return || std::isnan(truth_m.data()[i])) continue;
    returns += 1;
    if (image.reason.data()[i] != 0) continue;
    const double error_m = std::abs(image.range_m.data()[i] - truth_m.data()[i]);
    const bool is_wrong = error_m > wavelength_m / 2;
    if (!is_wrong) squares += error_m * error_m;
    pixels.push_back({image.confidence.data()[i], is_wrong});
    calibration.add(image.confidence.data()[i], !is_wrong);
  }
  const auto wrong_among = [&](std::size_t count) {
    const auto end = pixels.begin() + static_cast<std::ptrdiff_t>(count);
    return static_cast<double>(
        std::count_if(pixels.begin(), end, [](Pixel p) { return p.is_wrong; }));
  };
  if (pixels.empty()) return;
  const auto all = static_cast<double>(pixels.size());
  const double wrong = wrong_among(pixels.size());
  score.wrong_percent += 100 * wrong / all;
  score.worst_percent = std::max(score.worst_percent, 100 * wrong / all);
  score.coverage_percent += 100 * all / returns;
  score.range_rmse_m += std::sqrt(squares / std::max(1.0, all - wrong));
  std::ranges::stable_sort(pixels, std::ranges::greater(), &Pixel::confidence);
  const auto sure = std::min(static_cast<std::size_t>(0.9 * returns), pixels.size());
  score.sure_wrong_percent += 100 * wrong_among(sure) / static_cast<double>(sure);
}

/// Options, and a method of phase jumps that none of them names.
struct Variant {
  std::string name;
  UnwrapOptions options;
  std::optional<JumpMethod> jumps = std::nullopt;
};

/// What unwraps the frames of a case.
std::function<UnwrapResult(const DualFrequencyFrame&)> unwrapper_of(const Variant& variant,
                                                                    const SensorModel& sensor) {
  if (!variant.jumps) {
    return [unwrapper = Unwrapper(sensor, variant.options)](const auto& frame) mutable {
      return unwrapper.unwrap(frame);
    };
  }
  return [&variant, saturation_amplitude = sensor.saturation_amplitude,
          limits = beat_limits(sensor, variant.options.max_range_m),
          estimator = JumpEstimator()](const auto& frame) mutable {
    return unwrap_by_jumps(estimator, MeasuredFrame(frame, saturation_amplitude), limits,
                           *variant.jumps, variant.options);
  };
}

Score score_case(const Case& data, const Variant& variant) {
  Score score;
  Calibration calibration;
  const auto unwrap_frame = unwrapper_of(variant, data.sensor);
  const double wavelength_m = data.sensor.modulation.wavelength_a_m();
  for (std::size_t i = 0; i < data.frames.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    const UnwrapResult result = unwrap_frame(data.frames[i]);
    score.milliseconds +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    add_frame(data.frames[i], result.image, data.truth_m[i], wavelength_m, score, calibration);
    score.converged_percent += result.converged ? 100 : 0;
  }
  const auto frames = static_cast<double>(data.frames.size());
  for (double* mean : {&score.wrong_percent, &score.sure_wrong_percent, &score.coverage_percent,
                       &score.range_rmse_m, &score.converged_percent, &score.milliseconds}) {
    *mean /= frames;
  }
  score.calibration_error_percent = calibration.error_percent();
  return score;
}

/// Adds frames spread over the path through a scene.
void add_simulated(const std::string& scene, const SimulatorOptions& options, int frames,
                   Case& data) {
  const Simulator simulator(make_scene(scene, options.seed), options);
  data.sensor = simulator.sensor();
  data.sensor.max_range_m = 0;  // as for a camera that nobody told how large the room is
  const int total = *simulator.frame_count();
  for (int i = 0; i < frames; ++i) {
    SimulatedFrame simulated = simulator.simulate((2 * i + 1) * total / (2 * frames));
    data.frames.push_back(std::move(simulated.frame));
    data.truth_m.push_back(std::move(simulated.range_truth_m));
  }
}

struct Recording {
  const char* name;
  const char* scene;
  double range_noise_m = 0.02;
  double frequency_a_hz = 29e6;
  double frequency_b_hz = 31e6;
  int seeds = 1;
  int frames = 24;
};

/// 29 and 31 MHz and a range noise of 2 cm at 5 m where nothing else is said.
const std::vector<Recording> recordings{
    {"random rooms", "random", 0.02, 29e6, 31e6, 24, 3},
    {"random rooms, 5 cm", "random", 0.05, 29e6, 31e6, 24, 3},
    {"hall", "hall"},
    {"flat", "flat"},
    {"corridor", "corridor"},
    {"atrium", "atrium"},
    {"beyond", "beyond"},
    {"flat, 80/100 MHz", "flat", 0.02, 80e6, 100e6},
    {"flat, 37.65/45.18 MHz", "flat", 0.02, 37.65e6, 45.18e6},
    {"flat, 80 cm", "flat", 0.8},
};

/// The paper's experiments, and scenes with more counts than its two.
const std::vector<Recording> scenes_of_paper{
    {"wall", "wall"},
    {"slope", "slope"},
    {"room", "room"},
    {"hall", "hall"},
    {"flat", "flat"},
    {"corridor", "corridor"},
    {"atrium", "atrium"},
    {"beyond", "beyond"},
    {"random rooms", "random", 0.02, 29e6, 31e6, 24, 3},
    {"flat, 80/100 MHz", "flat", 0.02, 80e6, 100e6},
};

Case simulate(const Recording& recording, int divisor) {
  Case data{.name = recording.name, .sensor = {}, .frames = {}, .truth_m = {}};
  SimulatorOptions options;
  options.range_noise_m = recording.range_noise_m;
  options.frequency_a_hz = recording.frequency_a_hz;
  options.frequency_b_hz = recording.frequency_b_hz;
  const int seeds = std::max(1, recording.seeds > 1 ? recording.seeds / divisor : 1);
  const int frames = recording.seeds > 1 ? recording.frames : recording.frames / divisor;
  constexpr int first_seed = 101;
  for (int s = 0; s < seeds; ++s) {
    options.seed = first_seed + s;
    add_simulated(recording.scene, options, std::max(1, frames), data);
  }
  return data;
}

Case read_recording(const std::filesystem::path& folder, int divisor) {
  const SequenceReader source(folder);
  Case data{
      .name = folder.filename().string(), .sensor = source.sensor(), .frames = {}, .truth_m = {}};
  const int step = std::max(1, divisor * *source.frame_count() / 60);
  for (int i = 0; i < *source.frame_count(); i += step) {
    SourcedFrame sourced = source.read(i);
    if (!sourced.frame) continue;
    const auto name = source.files()[static_cast<std::size_t>(i)].phase_a.filename();
    const ImageU16 truth_mm = read_png_16(folder / "range_truth" / name);
    data.frames.push_back(std::move(*sourced.frame));
    data.truth_m.push_back((truth_mm == 0)
                               .select(ImageF::Constant(truth_mm.rows(), truth_mm.cols(), NAN),
                                       truth_mm.cast<float>() / 1000));
  }
  return data;
}

std::vector<Variant> methods() {
  std::vector<Variant> variants;
  for (const char* name : {"none", "pixel", "single", "paper", "jump", "joint"}) {
    variants.push_back({name, {}});
    variants.back().options.method = name;
  }
  return variants;
}

/// `joint` with one ingredient less, or more of one.
std::vector<Variant> ablations() {
  const auto variant = [](const char* name, const std::function<void(UnwrapOptions&)>& change) {
    Variant made{name, {}};
    change(made.options);
    return made;
  };
  return {
      variant("joint", [](UnwrapOptions&) {}),
      variant("no coarser scales", [](auto& o) { o.scales = 1; }),
      variant("amplitude tells of no edge", [](auto& o) { o.amplitude_edges = false; }),
      variant("mixed pixels believed", [](auto& o) { o.mixed_pixels = false; }),
      variant("no outliers", [](auto& o) { o.outlier_share = 1e-4; }),
      variant("surfaces face the camera (1 cm)", [](auto& o) { o.slope_m = 0.01; }),
      variant("1 iteration", [](auto& o) { o.count_iterations = 1; }),
      variant("10 iterations", [](auto& o) { o.count_iterations = 10; }),
      variant("ranges from A alone", [](auto& o) { o.fuse_frequencies = false; }),
  };
}

/// One departure from the paper after the other, until it is `jump`.
std::vector<Variant> departures() {
  std::vector<Variant> steps{{"paper", {}, JumpMethod{}}};
  const auto then = [&](const char* name, const std::function<void(JumpMethod&)>& depart) {
    steps.push_back(steps.back());
    steps.back().name = name;
    depart(*steps.back().jumps);
  };
  then("+ σ of slopes", [](JumpMethod& m) { m.has_sigma_of_image = false; });
  then("+ noise of pixels", [](JumpMethod& m) { m.has_noise_of_pixels = true; });
  then("+ all counts", [](JumpMethod& m) { m.has_all_counts = true; });
  then("+ sweeps together", [](JumpMethod& m) { m.schedule = MessageSchedule::together; });
  then("+ anchors by the residual", [](JumpMethod& m) { m.regards_residual = true; });
  steps.back().options.objection_share = 1e6;
  then("+ objection: `jump`", [](JumpMethod&) {});
  steps.back().options.objection_share = 1;
  return steps;
}

/// `jump` with one of its departures from the paper taken back.
std::vector<Variant> returns() {
  const auto variant = [](const char* name, const std::function<void(JumpMethod&)>& change) {
    Variant made{name, {}, jump_method(UnwrapMethod::jump)};
    change(*made.jumps);
    return made;
  };
  return {
      variant("jump", [](JumpMethod&) {}),
      variant("σ of the image, no noise",
              [](JumpMethod& m) {
                m.has_sigma_of_image = true;
                m.has_noise_of_pixels = false;
              }),
      variant("no noise", [](JumpMethod& m) { m.has_noise_of_pixels = false; }),
      variant("two counts", [](JumpMethod& m) { m.has_all_counts = false; }),
      variant("sweeps one by one", [](JumpMethod& m) { m.schedule = MessageSchedule::one_by_one; }),
      variant("residual unregarded", [](JumpMethod& m) { m.regards_residual = false; }),
  };
}

using Cell = std::function<std::string(const Score&)>;

std::string formatted(const char* format, double value, double other = 0) {
  char text[64];
  std::snprintf(text, sizeof(text), format, value, other);
  return text;
}

void print_table(const std::string& title, const std::vector<Case>& cases,
                 const std::vector<Variant>& variants,
                 const std::vector<std::vector<Score>>& scores, const Cell& cell) {
  std::cout << "\n| " << title << " |";
  for (const Variant& variant : variants) std::cout << ' ' << variant.name << " |";
  std::cout << "\n|---|";
  for (std::size_t v = 0; v < variants.size(); ++v) std::cout << "---|";
  std::cout << '\n';
  for (std::size_t c = 0; c < cases.size(); ++c) {
    std::cout << "| " << cases[c].name << " |";
    for (const std::vector<Score>& of_variant : scores) {
      std::cout << ' ' << cell(of_variant[c]) << " |";
    }
    std::cout << '\n';
  }
  std::cout.flush();
}

std::vector<std::vector<Score>> score_all(const std::vector<Case>& cases,
                                          const std::vector<Variant>& variants) {
  std::vector<std::vector<Score>> scores;
  for (const Variant& variant : variants) {
    scores.emplace_back();
    for (const Case& data : cases) scores.back().push_back(score_case(data, variant));
  }
  return scores;
}

const Cell wrong = [](const Score& s) {
  return formatted("%.2f / %.1f", s.wrong_percent, s.worst_percent);
};
const Cell converged = [](const Score& s) { return formatted("%.0f", s.converged_percent); };

void print_all(const std::vector<Case>& cases) {
  const Cell sure = [](const Score& s) { return formatted("%.3f", s.sure_wrong_percent); };
  const std::vector<Variant> all = methods();
  const auto of_methods = score_all(cases, all);
  print_table("wrong wraps, %, mean / worst frame", cases, all, of_methods, wrong);
  print_table("the same, 90 % most confident pixels", cases, all, of_methods, sure);
  print_table("calibration error of the confidence, %", cases, all, of_methods,
              [](const Score& s) { return formatted("%.1f", s.calibration_error_percent); });
  print_table("pixels with a range, %", cases, all, of_methods,
              [](const Score& s) { return formatted("%.1f", s.coverage_percent); });
  print_table("error of right ranges, RMS, cm", cases, all, of_methods,
              [](const Score& s) { return formatted("%.1f", 100 * s.range_rmse_m); });
  print_table("milliseconds a frame, one core", cases, all, of_methods,
              [](const Score& s) { return formatted("%.1f", s.milliseconds); });
  const std::vector<Variant> without = ablations();
  print_table("wrong wraps, %, mean / worst frame", cases, without, score_all(cases, without),
              wrong);
}

void print_departures(const std::vector<Case>& cases) {
  for (const std::vector<Variant>& variants : {departures(), returns()}) {
    const auto scores = score_all(cases, variants);
    print_table("wrong wraps, %, mean / worst frame", cases, variants, scores, wrong);
    print_table("frames that converge, %", cases, variants, scores, converged);
  }
}

int run(int count, char** arguments) {
  int divisor = 1;
  bool only_departures = false;
  std::vector<Case> cases;
  std::vector<std::filesystem::path> folders;
  for (int i = 1; i < count; ++i) {
    if (std::strcmp(arguments[i], "--divide") == 0 && i + 1 < count) {
      divisor = std::max(1, std::atoi(arguments[++i]));
    } else if (std::strcmp(arguments[i], "--departures") == 0) {
      only_departures = true;
    } else {
      folders.emplace_back(arguments[i]);
    }
  }
  for (const Recording& recording : only_departures ? scenes_of_paper : recordings)
    cases.push_back(simulate(recording, divisor));
  for (const auto& folder : folders) cases.push_back(read_recording(folder, divisor));
  only_departures ? print_departures(cases) : print_all(cases);
  return 0;
}

}  // namespace
}  // namespace tofmap

int main(int count, char** arguments) {
  try {
    return tofmap::run(count, arguments);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
