// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures the time of each stage on one core, for a frame of the simulated room of 176 x 144
// pixels.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <tofmap/pipeline/pipeline.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// Two successive frames from the middle of the path, prepared for mapping.
struct Example {
  Simulator simulator;
  PixelRays rays;
  PipelineOptions options;
  Frame frame = blank_frame(2);
  PreparedFrame prepared;
  PreparedFrame next;

  Example() : simulator(make_scene("room"), {}), rays(pixel_rays(simulator.sensor().camera)) {
    omp_set_num_threads(1);
    const int middle = *simulator.frame_count() / 2;
    frame = simulator.simulate(middle).frame;
    Unwrapper unwrapper(simulator.sensor(), options.unwrap);
    const SensorModel& sensor = simulator.sensor();
    FrameMeasurer measurer(sensor, options.unwrap);
    prepared = prepare_frame(measure_frame(frame, measurer), unwrapper, sensor, rays, options);
    next = prepare_frame(measure_frame(simulator.simulate(middle + 1).frame, measurer), unwrapper,
                         sensor, rays, options);
  }
};

const Example& example() {
  static const Example made;
  return made;
}

void unwrap_by(benchmark::State& state, const std::string& method) {
  const Example& e = example();
  UnwrapOptions options;
  options.method = find_named<UnwrapMethod>(method).value();
  Unwrapper unwrapper(e.simulator.sensor(), options);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(unwrapper.unwrap(e.frame));
}
BENCHMARK_CAPTURE(unwrap_by, pixel, "pixel")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(unwrap_by, single, "single")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(unwrap_by, jump, "jump")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(unwrap_by, joint, "joint")->Unit(benchmark::kMillisecond);

void filter(benchmark::State& state) {
  const Example& e = example();
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(apply_filters(e.prepared.unwrapped.image, e.frame,
                                           e.simulator.sensor().modulation, e.rays,
                                           e.options.filters));
  }
}
BENCHMARK(filter)->Unit(benchmark::kMillisecond);

void make_cloud(benchmark::State& state) {
  const Example& e = example();
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(surface_cloud(e.prepared.filtered.image, e.rays, e.options.cloud));
  }
}
BENCHMARK(make_cloud)->Unit(benchmark::kMillisecond);

/// Registers a frame with one keyframe, the frame before it.
void register_frame(benchmark::State& state) {
  const Example& e = example();
  for ([[maybe_unused]] auto _ : state) {
    state.PauseTiming();
    Odometry odometry(e.simulator.sensor().camera, e.options.odometry, e.options.registration,
                      e.options.loops);
    odometry.track(e.prepared.timestamp_s, *e.prepared.cloud, {});
    const Keyframe keyframe{0, 0, e.prepared.timestamp_s, Pose::Identity(), e.prepared.cloud};
    const Keyframe* const around = &keyframe;
    state.ResumeTiming();
    benchmark::DoNotOptimize(odometry.track(e.next.timestamp_s, *e.next.cloud, {&around, 1}));
  }
}
BENCHMARK(register_frame)->Unit(benchmark::kMillisecond);

void integrate_into_map(benchmark::State& state) {
  const Example& e = example();
  SurfaceMap map(e.options.map);
  for ([[maybe_unused]] auto _ : state) map.integrate(*e.prepared.cloud, Pose::Identity());
}
BENCHMARK(integrate_into_map)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace tofmap
