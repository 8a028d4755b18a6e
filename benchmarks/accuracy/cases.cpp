// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "cases.hpp"

#include "frozen.hpp"
#include "text.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include <tofmap/acquisition/png_image.hpp>
#include <tofmap/acquisition/sequence.hpp>

namespace tofmap::accuracy {
namespace {

constexpr RunPlan scene_plan{.runs = 6, .frames = 8};
constexpr RunPlan room_plan{.runs = 1, .frames = 6};
constexpr RunPlan recording_plan{.runs = 8, .frames = 8};
constexpr int rooms = 24;

RunPlan divided(RunPlan plan, int divisor) {
  plan.runs = std::max(1, plan.runs / divisor);
  return plan;
}

/// A simulated recording. The default noise is 2 cm at 5 m.
struct Recording {
  const char* name;
  const char* scene;
  double range_noise_m = 0.02;
  double frequency_a_hz = 29e6;
  double frequency_b_hz = 31e6;
};

constexpr Recording development[] = {
    {"random rooms", "random"},
    {"random rooms, 5 cm", "random", 0.05},
    {"hall", "hall"},
    {"flat", "flat"},
    {"corridor", "corridor"},
    {"atrium", "atrium"},
    {"beyond", "beyond"},
    {"passage", "passage"},
    {"flat, 80/100 MHz", "flat", 0.02, 80e6, 100e6},
    {"flat, 37.65/45.18 MHz", "flat", 0.02, 37.65e6, 45.18e6},
    {"flat, 80 cm", "flat", 0.8},
};
/// Recordings for the departures of `jump` from the paper. These are development data as well.
constexpr Recording of_paper[] = {
    {"wall", "wall"},           {"slope", "slope"},
    {"room", "room"},           {"hall", "hall"},
    {"flat", "flat"},           {"corridor", "corridor"},
    {"atrium", "atrium"},       {"beyond", "beyond"},
    {"random rooms", "random"}, {"flat, 80/100 MHz", "flat", 0.02, 80e6, 100e6},
};
constexpr int first_case_seed = 101;

void add_runs(const Simulator& simulator, const RunPlan& plan, Case& data) {
  data.sensor = simulator.sensor();
  const int total = *simulator.frame_count();
  for (const int start : run_starts(total, plan)) {
    Run run;
    for (int i = start; i < std::min(total, start + plan.frames); ++i) {
      SimulatedFrame simulated = simulator.simulate(i);
      run.frames.push_back(std::move(simulated.frame));
      run.truth_m.push_back(std::move(simulated.range_truth_m));
    }
    data.runs.push_back(std::move(run));
  }
}

/// A case of a simulated scene: for scene "random", one room for each of the seeds; for other
/// scenes, runs of the first seed only.
Case simulated_case(const std::string& name, const std::string& scene, SimulatorOptions options,
                    int first_seed, int seeds, int divisor) {
  Case data{.name = name, .sensor = {}, .runs = {}};
  const bool is_drawn = scene == "random";
  const int count = is_drawn ? std::max(1, seeds / divisor) : 1;
  for (int seed = first_seed; seed < first_seed + count; ++seed) {
    options.seed = seed;
    add_runs(Simulator(frozen::make_scene(scene, seed), options),
             is_drawn ? room_plan : divided(scene_plan, divisor), data);
  }
  return data;
}

std::vector<Case> simulated_cases(std::span<const Recording> recordings, int divisor) {
  std::vector<Case> cases;
  for (const Recording& recording : recordings) {
    SimulatorOptions options;
    options.range_noise_m = recording.range_noise_m;
    options.frequency_a_hz = recording.frequency_a_hz;
    options.frequency_b_hz = recording.frequency_b_hz;
    cases.push_back(
        simulated_case(recording.name, recording.scene, options, first_case_seed, rooms, divisor));
  }
  return cases;
}

ImageF metres(const ImageU16& truth_mm) {
  return (truth_mm == 0)
      .select(ImageF::Constant(truth_mm.rows(), truth_mm.cols(), NAN),
              truth_mm.cast<float>() / 1000);
}

}  // namespace

std::vector<int> run_starts(int total, const RunPlan& plan, double shift) {
  std::vector<int> starts;
  const int last = std::max(0, total - plan.frames);
  for (int r = 0; r < plan.runs; ++r) {
    starts.push_back(
        std::min(last, static_cast<int>((r + shift) * static_cast<double>(total) / plan.runs)));
  }
  return starts;
}

std::vector<Case> development_cases(int divisor) { return simulated_cases(development, divisor); }

std::vector<Case> paper_cases(int divisor) { return simulated_cases(of_paper, divisor); }

std::vector<Case> frozen_cases(int divisor) {
  std::vector<Case> cases;
  int seed = frozen::first_seed;
  for (const frozen::Place& place : frozen::places) {
    SimulatorOptions options;
    options.width_px = frozen::width_px;
    options.height_px = frozen::height_px;
    options.range_noise_m = place.range_noise_m;
    options.frequency_a_hz = place.frequency_a_hz;
    options.frequency_b_hz = place.frequency_b_hz;
    const std::string name =
        fmt::format("{}, {:g}/{:g} MHz, {:.1f} cm", place.scene, place.frequency_a_hz / 1e6,
                    place.frequency_b_hz / 1e6, 100 * place.range_noise_m);
    cases.push_back(simulated_case(name, place.scene, options, seed, rooms / 2, divisor));
    if (std::string_view(place.scene) == "random") seed += rooms / 2;
  }
  return cases;
}

Case recorded_case(const std::filesystem::path& folder, int divisor) {
  const SequenceReader source(folder);
  Case data{.name = folder.filename().string(), .sensor = source.sensor(), .runs = {}};
  data.sensor.max_range_m = 0;
  const int total = *source.frame_count();
  const RunPlan plan = divided(recording_plan, divisor);
  for (const int start : run_starts(total, plan)) {
    Run run;
    for (int i = start; i < std::min(total, start + plan.frames); ++i) {
      SourcedFrame sourced = source.read(i);
      if (!sourced.frame) continue;
      const auto name = source.files()[static_cast<std::size_t>(i)].phases.front().filename();
      run.frames.push_back(std::move(*sourced.frame));
      run.truth_m.push_back(metres(read_png_16(folder / "range_truth" / name)));
    }
    data.runs.push_back(std::move(run));
  }
  return data;
}

std::string describe_runs(int divisor) {
  return fmt::format(
      "Frames come as runs of consecutive frames, one camera each: {} runs of {} frames of each "
      "scene, one of {} frames of each random room, {} of {} of each recording.",
      divided(scene_plan, divisor).runs, scene_plan.frames, room_plan.frames,
      divided(recording_plan, divisor).runs, recording_plan.frames);
}

void score_run(const Run& run, const SensorModel& sensor, const Variant& variant, Score& score) {
  const UnwrapFrame unwrap_frame = unwrapper_of(variant, sensor, run.frames);
  const double wavelength_m = sensor.modulation.wavelength_m(0);
  for (std::size_t i = 0; i < run.frames.size(); ++i) {
    const auto start = std::chrono::steady_clock::now();
    const UnwrapResult result = unwrap_frame(run.frames[i]);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    add_frame(run.frames[i], result.image, run.truth_m[i], wavelength_m, score);
    score.frames.back().is_converged = result.converged.value_or(false);
    score.frames.back().milliseconds = taken.count();
  }
}

Score score_case(const Case& data, const Variant& variant) {
  Score score;
  for (const Run& run : data.runs) score_run(run, data.sensor, variant, score);
  return score;
}

}  // namespace tofmap::accuracy
