// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures the time of each unwrapping method at several image sizes, the time of message passing
// alone and, for comparison, the memory bandwidth and the multiply-adds per second of the machine.

#include <array>
#include <map>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <omp.h>

#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>
#include <tofmap/unwrap/jump/jump_estimate.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

struct Size {
  int width_px;
  int height_px;
};
constexpr std::array<Size, 3> sizes{{{176, 144}, {320, 240}, {640, 480}}};

struct Example {
  SensorModel sensor;
  Frame frame = blank_frame(2);
};

/// A frame of the simulated room. The sensor does not state its largest range, so that there are
/// fourteen possible wrap counts.
const Example& example(const Size& size) {
  static std::map<int, Example> made;
  const auto found = made.find(size.width_px);
  if (found != made.end()) return found->second;
  SimulatorOptions options;
  options.width_px = size.width_px;
  options.height_px = size.height_px;
  const Simulator simulator(make_scene("room"), options);
  Example& e = made[size.width_px];
  e.frame = simulator.simulate(*simulator.frame_count() / 2).frame;
  e.sensor = simulator.sensor();
  return e;
}

void unwrap_frames(benchmark::State& state, const std::string& method, const Size& size) {
  omp_set_num_threads(1);
  const Example& e = example(size);
  UnwrapOptions options;
  options.method = find_named<UnwrapMethod>(method).value();
  Unwrapper unwrapper(e.sensor, options);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(unwrapper.unwrap(e.frame));
  state.SetItemsProcessed(state.iterations());
}

/// Adds a counter of pixels times iterations per second.
void count_pixel_iterations(benchmark::State& state, const Size& size, int iterations) {
  const double pixels = static_cast<double>(size.width_px) * size.height_px;
  state.counters["pixel_iterations"] = benchmark::Counter(
      pixels * iterations * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void pass_count_messages(benchmark::State& state, const Size& size) {
  constexpr int iterations = 3;
  const Example& e = example(size);
  WrapCountModel model;
  model.assign(e.frame, unwrap_limits(e.sensor, 0),
               PhaseSigma(e.frame, estimate_phase_noise(e.frame)), {0, 0}, {});
  WrapCountPropagation propagation;
  for ([[maybe_unused]] auto _ : state)
    benchmark::DoNotOptimize(propagation.run(model, iterations));
  count_pixel_iterations(state, size, iterations);
}

void pass_jump_messages(benchmark::State& state, const Size& size) {
  constexpr int iterations = 5;
  const Example& e = example(size);
  UnwrapOptions options;
  options.method = UnwrapMethod::jump;
  JumpEstimator estimator;
  const JumpEstimate& jumps = estimator.estimate(
      e.frame, PhaseSigma(e.frame, estimate_phase_noise(e.frame)),
      unwrap_limits(e.sensor, 0).pair(0, 1), jump_method(UnwrapMethod::jump), options);
  JumpPropagation propagation;
  JumpBeliefs beliefs;
  for ([[maybe_unused]] auto _ : state) {
    propagation.run(jumps.evidence, iterations, beliefs, iterations);
    benchmark::DoNotOptimize(beliefs);
  }
  count_pixel_iterations(state, size, iterations);
}

/// Computes a = b + s c on arrays far larger than the caches. Three numbers are transferred per
/// element.
void stream_bandwidth(benchmark::State& state) {
  constexpr std::size_t count = 1U << 25U;
  std::vector<float> a(count);
  const std::vector<float> b(count, 1.0F);
  const std::vector<float> c(count, 2.0F);
  for ([[maybe_unused]] auto _ : state) {
    for (std::size_t i = 0; i < count; ++i) a[i] = b[i] + 0.5F * c[i];
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(3 * count * sizeof(float)));
}

constexpr int fma_width = 128;  // eight AVX-512 registers, enough to hide the latency
constexpr int fma_rounds = 1000;

/// Multiply-adds on numbers that stay in registers, with the widest vectors of the processor.
[[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]] float multiply_add(
    float factor) {
  std::array<float, fma_width> sums{};
  for (int round = 0; round < fma_rounds; ++round) {
#pragma GCC unroll 128
    for (float& sum : sums) sum = sum * factor + 1.0F;
  }
  float total = 0;
  for (const float sum : sums) total += sum;
  return total;
}

void fma_rate(benchmark::State& state) {
  float factor = 0.999F;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(factor);
    benchmark::DoNotOptimize(multiply_add(factor));
  }
  state.counters["flop"] =
      benchmark::Counter(2.0 * fma_width * fma_rounds * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate);
}

void register_all() {
  const int cores = omp_get_num_procs();
  for (const Size& size : sizes) {
    const std::string name =
        "/" + std::to_string(size.width_px) + "x" + std::to_string(size.height_px);
    for (const char* method : {"none", "pixel", "single", "paper", "jump", "joint"}) {
      benchmark::RegisterBenchmark(
          ("unwrap/" + std::string(method) + name).c_str(),
          [=](benchmark::State& state) { unwrap_frames(state, method, size); })
          ->Unit(benchmark::kMillisecond)
          ->ThreadRange(1, cores)
          ->UseRealTime();
    }
    benchmark::RegisterBenchmark(("messages/joint" + name).c_str(), [=](benchmark::State& state) {
      pass_count_messages(state, size);
    })->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("messages/jump" + name).c_str(), [=](benchmark::State& state) {
      pass_jump_messages(state, size);
    })->Unit(benchmark::kMillisecond);
  }
  benchmark::RegisterBenchmark("machine/stream", stream_bandwidth)->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("machine/fma", fma_rate)->Unit(benchmark::kMicrosecond);
}

}  // namespace
}  // namespace tofmap

int main(int count, char** arguments) {
  for (const tofmap::Size& size : tofmap::sizes) tofmap::example(size);
  tofmap::register_all();
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
