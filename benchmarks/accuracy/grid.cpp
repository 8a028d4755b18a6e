// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "grid.hpp"

#include "frozen.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>

#include <tofmap/simulation/ideal_frame.hpp>

namespace tofmap::accuracy {
namespace {

/// The motion of the camera, and the delay of B.
struct Motion {
  double delay_share = 0;  ///< delay of B after A, frame periods
  bool is_fast = false;

  auto operator<=>(const Motion&) const = default;
};

/// The motion for a combination of errors. It is fast if the camera exposes A and B in alternate
/// frames (delay of one frame).
Motion motion_of(const CameraErrors& errors) {
  return {errors.delay_share, errors.delay_share == 1};
}

Motion without_delay(Motion motion) { return {0, motion.is_fast}; }

/// Noise-free frames of one place with one motion.
struct IdealRuns {
  SensorModel sensor;
  std::vector<std::vector<IdealFrame>> runs;
};

using IdealPlace = std::map<Motion, IdealRuns>;

IdealRuns cast_runs(const GridPlace& place, const Motion& motion, const RunPlan& plan) {
  SimulatorOptions options = place.options;
  options.b_delay_share = motion.delay_share;
  if (motion.is_fast) {
    options.max_translation_m = 0.1;
    options.max_rotation_deg = 6;
  }
  Scene scene = frozen::make_scene(place.scene, place.seed);
  scene.min_frames = 2;  // so that only the limits of motion determine the speed of the camera
  const Simulator simulator(std::move(scene), options);
  IdealRuns out{simulator.sensor(), {}};
  const int total = *simulator.frame_count();
  // Each seed starts at other frames.
  const double shift = 0.15 + 0.3 * (place.seed % 3);
  for (const int start : run_starts(total, plan, shift)) {
    std::vector<IdealFrame> run;
    for (int i = start; i < std::min(total, start + plan.frames); ++i) {
      run.push_back(simulator.ideal(i));
    }
    out.runs.push_back(std::move(run));
  }
  return out;
}

IdealPlace cast_place(const GridPlace& place, const std::vector<Combination>& combinations,
                      const RunPlan& plan) {
  IdealPlace out;
  for (const Combination& combination : combinations) {
    const Motion motion = motion_of(combination.errors);
    for (const Motion& wanted : {motion, without_delay(motion)}) {
      if (!out.contains(wanted)) out.emplace(wanted, cast_runs(place, wanted, plan));
    }
  }
  return out;
}

Run measured_run(const std::vector<IdealFrame>& ideal, const SensorModel& sensor,
                 const SimulatorOptions& options) {
  Run run;
  for (const IdealFrame& frame : ideal) {
    run.frames.push_back(measured_frame(frame, sensor, options));
    run.truth_m.push_back(frame.range_truth_m);
  }
  return run;
}

/// The scores of several methods for one camera at one place.
std::vector<Score> score_methods(const GridPlace& place, const IdealRuns& ideal,
                                 const CameraErrors& errors,
                                 const std::vector<const char*>& methods) {
  const SimulatorOptions options = with_errors(place.options, errors);
  std::vector<Score> scores(methods.size());
  for (const std::vector<IdealFrame>& frames : ideal.runs) {
    const Run run = measured_run(frames, ideal.sensor, options);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      Variant variant{.name = methods[m]};
      variant.options.method = find_named<UnwrapMethod>(methods[m]).value();
      score_run(run, ideal.sensor, variant, scores[m]);
    }
  }
  return scores;
}

/// The reference of a row: the same noise and motion, without systematic errors and without delay
/// of B.
struct Reference {
  double noise_m = 0;
  Motion motion;

  auto operator<=>(const Reference&) const = default;
};

Reference reference_of(const CameraErrors& errors) {
  return {errors.noise_m, without_delay(motion_of(errors))};
}

using References = std::map<Reference, Score>;

References measure_references(const GridPlace& place, const IdealPlace& ideal,
                              const std::vector<Combination>& combinations) {
  References out;
  for (const Combination& combination : combinations) out[reference_of(combination.errors)] = {};
  std::vector<References::value_type*> all;
  for (auto& reference : out) all.push_back(&reference);
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Reference& reference = all[i]->first;
    const CameraErrors errors{.noise_m = reference.noise_m};
    all[i]->second = score_methods(place, ideal.at(reference.motion), errors, {"joint"})[0];
  }
  return out;
}

std::vector<GridRow> measure_place(const GridPlace& place,
                                   const std::vector<Combination>& combinations,
                                   const RunPlan& plan) {
  const IdealPlace ideal = cast_place(place, combinations, plan);
  const References references = measure_references(place, ideal, combinations);
  std::vector<GridRow> rows(combinations.size());
#pragma omp parallel for schedule(dynamic)
  for (std::size_t c = 0; c < combinations.size(); ++c) {
    const CameraErrors& errors = combinations[c].errors;
    const auto scores =
        score_methods(place, ideal.at(motion_of(errors)), errors, {"pixel", "jump", "joint"});
    rows[c] = {c,
               place.scene,
               place.seed,
               scores[0],
               scores[1],
               scores[2],
               references.at(reference_of(errors))};
  }
  return rows;
}

/// Each seed is a different camera.
constexpr int seeds_per_scene = 3;
constexpr int first_grid_seed = 11;

std::vector<GridPlace> places_of(const frozen::Place& place, const SimulatorOptions& base,
                                 int first_seed, int seeds) {
  std::vector<GridPlace> out;
  for (int seed = first_seed; seed < first_seed + seeds; ++seed) {
    SimulatorOptions options = base;
    options.frequency_a_hz = place.frequency_a_hz;
    options.frequency_b_hz = place.frequency_b_hz;
    options.seed = seed;
    options.errors_seed = seed;
    out.push_back({place.scene, seed, options});
  }
  return out;
}

std::vector<GridPlace> grid_places(const GridSettings& settings) {
  std::vector<frozen::Place> scenes;
  for (const char* name : {"hall", "random", "flat", "room", "passage"}) {
    scenes.push_back({name, 29e6, 31e6, 0});
  }
  SimulatorOptions base;
  if (settings.frozen) {
    scenes.assign(std::begin(frozen::grid_places), std::end(frozen::grid_places));
    base.width_px = frozen::width_px;
    base.height_px = frozen::height_px;
  }
  if (settings.quick) scenes.resize(2);
  if (settings.quick || settings.half) {
    base.width_px /= 2;
    base.height_px /= 2;
  }
  std::vector<GridPlace> places;
  for (const frozen::Place& scene : scenes) {
    const int first = settings.frozen ? frozen::first_seed + 50 : first_grid_seed;
    const auto added = places_of(scene, base, first, settings.quick ? 1 : seeds_per_scene);
    places.insert(places.end(), added.begin(), added.end());
  }
  return places;
}

}  // namespace

Grid measure_grid(const GridSettings& settings) {
  GridPlan plan{.with_pairs = !settings.quick,
                .drawn = settings.quick ? 6 : 40,
                .seed = settings.frozen ? frozen::combinations_seed : 1};
  Grid grid{error_combinations(plan), {}, {.runs = 2, .frames = settings.quick ? 4 : 8}};
  for (const GridPlace& place : grid_places(settings)) {
    std::fprintf(stderr, "%s, seed %d\n", place.scene.c_str(), place.seed);
    auto rows = measure_place(place, grid.combinations, grid.runs);
    std::move(rows.begin(), rows.end(), std::back_inserter(grid.rows));
  }
  return grid;
}

}  // namespace tofmap::accuracy
