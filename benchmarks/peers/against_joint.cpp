// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Compares the method `joint` with its peers on simulated frames of a camera with the frequencies,
// the size and the lens of the Kinect v2 (benchmarks/peers/README.md).

#include "peers/kde_unwrap.hpp"
#include "peers/libfreenect2_unwrap.hpp"
#include "peers/phase_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <malloc.h>

#include <tofmap/acquisition/kinect2/phases.hpp>
#include <tofmap/simulation/kinect2_recording.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

struct Place {
  const char* scene;
  double range_noise_m;  ///< SimulatorOptions::range_noise_m
  int seed;
};

/// A camera like the Kinect v2.
SimulatorOptions kinect_options(const Place& place, bool has_errors) {
  SimulatorOptions options = kinect2_simulator_options();
  options.frame_rate_hz = SimulatorOptions().frame_rate_hz;
  options.max_translation_m = SimulatorOptions().max_translation_m;
  options.max_rotation_deg = SimulatorOptions().max_rotation_deg;
  options.range_noise_m = place.range_noise_m;
  options.seed = place.seed;
  options.subpixels = 2;
  if (!has_errors) return options;
  options.errors_seed = place.seed;
  options.offsets_m = {0.02, -0.03, 0.01};
  options.periodic_errors_m = {0.008, 0.02, 0.005};
  options.amplitude_errors_m = {0.01, 0.04, -0.01};
  options.fixed_pattern_m = 0.003;
  options.multipath_rays = 8;
  options.ambient_noise = 2;
  options.exposure_share = 0.2;
  return options;
}

/// Pixels farther away are not scored.
constexpr float farthest_m = 18;

/// The pixels of all frames that a method gave a range, with their errors.
class Tally {
 public:
  void add(const ImageF& range_m, const ImageF& confidence, const ImageF& truth_m) {
    for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
      // Beyond the combined range of 18.7 m, no method can be right.
      if (!(truth_m.data()[i] <= farthest_m)) continue;
      ++expected_;
      if (std::isnan(range_m.data()[i])) continue;
      pixels_.push_back({confidence.data()[i], std::abs(range_m.data()[i] - truth_m.data()[i])});
    }
  }

  double coverage() const { return static_cast<double>(pixels_.size()) / expected_; }

  /// Percentage of pixels whose range is off by more than `limit_m`, among the most confident ones
  /// that make this share of all pixels.
  double wrong_percent(double coverage, double limit_m) {
    std::ranges::sort(pixels_, std::ranges::greater(), &Pixel::confidence);
    const auto kept = std::min(pixels_.size(), static_cast<std::size_t>(coverage * expected_));
    const auto wrong = std::count_if(pixels_.begin(), pixels_.begin() + static_cast<long>(kept),
                                     [&](const Pixel& pixel) { return pixel.error_m > limit_m; });
    return kept == 0 ? 0 : 100.0 * static_cast<double>(wrong) / static_cast<double>(kept);
  }

 private:
  struct Pixel {
    float confidence;
    float error_m;
  };
  double expected_ = 0;
  std::vector<Pixel> pixels_;
};

/// Processor time of a call, milliseconds.
template <class Call>
double timed_ms(const Call& call) {
  const std::clock_t start = std::clock();
  call();
  return 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// What the peers get of a frame: amplitudes with libfreenect2's factors.
peers::ThreePhases three_phases(const Frame& frame) {
  peers::ThreePhases out;
  for (std::size_t f = 0; f < 3; ++f) {
    out.phase_cycles[f] = frame.phases[f];
    out.amplitude[f] = static_cast<float>(kinect2::amplitude_factors[f]) * frame.amplitudes[f];
  }
  return out;
}

/// The facts that the peers need of the simulated camera: the scale at which their model of the
/// noise gives that of 80 MHz at 5 m on a surface of reflectance 0.5.
peers::CameraFacts facts_about(const Place& place, const Modulation& modulation) {
  // The contrast at 80 MHz is the inverse of its factor.
  const double sigma_rad = kinect2::amplitude_factors[0] * 2 * std::numbers::pi *
                           place.range_noise_m / modulation.wavelength_m(0);
  const double theirs = peers::amplitude_of_q(peers::kinect_v2_noise[0], 1 / std::sin(sigma_rad));
  constexpr double simulated = amplitude_unit * 0.5 / (5.0 * 5.0);
  peers::CameraFacts facts;
  facts.amplitude_scale = theirs / simulated;
  return facts;
}

struct Method {
  std::string name;
  Tally tally;
  double milliseconds = 0;
};

void compare(const Place& place, bool has_errors, int frames, int pairs) {
  const SimulatorOptions options = kinect_options(place, has_errors);
  const Simulator simulator(make_scene(place.scene, options.seed), options);
  const int total = *simulator.frame_count();
  UnwrapOptions unwrap_options;
  Unwrapper unwrapper(simulator.sensor(), unwrap_options);
  const SensorModel pair_sensor = with_frequencies(simulator.sensor(), {0, 1});
  UnwrapOptions pair_options;
  pair_options.max_range_m = combined_range_m(simulator.sensor().modulation, 0.05);
  Unwrapper pair_unwrapper(pair_sensor, pair_options);
  // Parts of the path: from each, a few frames follow each other.
  constexpr int run = 3;
  std::vector<Frame> measured;
  std::vector<ImageF> truth_m;
  for (int start = 0; start < frames; ++start) {
    for (int i = 0; i < run; ++i) {
      const int index = std::min(total - 1, start * total / frames + i);
      SimulatedFrame simulated = simulator.simulate(index);
      measured.push_back(std::move(simulated.frame));
      truth_m.push_back(std::move(simulated.range_truth_m));
    }
  }
  unwrapper.look_ahead(std::span(measured).first(std::min<std::size_t>(8, measured.size())));
  const peers::CameraFacts facts = facts_about(place, simulator.sensor().modulation);
  Method joint{"joint", {}, 0};
  Method kde_2{"KDE, 2 hypotheses", {}, 0};
  Method kde_3{"KDE, 3 hypotheses", {}, 0};
  Method kde_3_raw{"KDE, 3, unsmoothed", {}, 0};
  Method libfreenect2{"libfreenect2", {}, 0};
  double pair_ms = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    UnwrapResult result;
    joint.milliseconds += timed_ms([&] { result = unwrapper.unwrap(measured[i]); });
    joint.tally.add(result.image.range_m, result.image.confidence, truth_m[i]);
    if (pairs > 0) {
      const Frame pair = with_frequencies(measured[i], {0, 1});
      pair_ms += timed_ms([&] { pair_unwrapper.unwrap(pair); });
    }
    const peers::ThreePhases phases = three_phases(measured[i]);
    const auto run_kde = [&](int hypotheses, bool smooth, Method& method) {
      peers::KdeOptions kde;
      kde.hypotheses = hypotheses;
      kde.smooth = smooth;
      kde.min_confidence = 0;
      kde.camera = facts;
      peers::KdeResult found;
      method.milliseconds += timed_ms([&] { found = peers::kde_unwrap(phases, kde); });
      method.tally.add(found.range_m, found.confidence, truth_m[i]);
    };
    run_kde(2, true, kde_2);
    run_kde(3, true, kde_3);
    run_kde(3, false, kde_3_raw);
    peers::Libfreenect2Options own;
    own.reject_outliers = false;
    own.camera = facts;
    peers::Libfreenect2Result found;
    libfreenect2.milliseconds += timed_ms([&] { found = peers::libfreenect2_unwrap(phases, own); });
    libfreenect2.tally.add(found.range_m, ImageF::Ones(424, 512), truth_m[i]);
  }
  std::printf("%s, noise %.0f mm, seed %d%s, %zu frames\n", place.scene, 1000 * place.range_noise_m,
              place.seed, has_errors ? ", with errors" : "", measured.size());
  std::printf("  %-20s %9s", "", "coverage");
  for (const double coverage : {1.0, 0.99, 0.95, 0.9})
    std::printf(" | %7.0f %% kept", 100 * coverage);
  std::printf(" |   ms\n");
  for (Method* method : {&joint, &kde_2, &kde_3, &kde_3_raw, &libfreenect2}) {
    std::printf("  %-20s %7.2f %%", method->name.c_str(), 100 * method->tally.coverage());
    for (const double coverage : {1.0, 0.99, 0.95, 0.9}) {
      std::printf(" | %6.3f %6.3f", method->tally.wrong_percent(coverage, 0.9369),
                  method->tally.wrong_percent(coverage, 0.3));
    }
    std::printf(" | %4.0f\n", method->milliseconds / static_cast<double>(measured.size()));
  }
  if (pairs > 0) {
    std::printf("  joint of 80 and 16 MHz up to the same range: %.0f ms\n",
                pair_ms / static_cast<double>(measured.size()));
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace tofmap

int main(int argc, char** argv) {
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 2000000000);
  CLI::App app{"compares joint with its peers at 80, 16 and 120 MHz"};
  std::vector<std::string> scenes{"room", "hall", "corridor", "atrium"};
  std::vector<double> noises_m{0.01, 0.02, 0.04};
  int frames = 3;
  int seed = 1;
  int pairs = 1;
  std::vector<int> errors{0, 1};
  app.add_option("--scenes", scenes, "scenes")->delimiter(',');
  app.add_option("--noises", noises_m, "range noise at 5 m, metres")->delimiter(',');
  app.add_option("--frames", frames, "parts of the path, of three frames each");
  app.add_option("--seed", seed, "seed of noise and errors");
  app.add_option("--errors", errors, "0: without systematic errors, 1: with them")->delimiter(',');
  app.add_option("--pairs", pairs, "1: times two frequencies, too");
  CLI11_PARSE(app, argc, argv);
  for (const std::string& scene : scenes) {
    for (const double noise_m : noises_m) {
      for (const int has_errors : errors) {
        tofmap::compare({scene.c_str(), noise_m, seed}, has_errors != 0, frames, pairs);
      }
    }
  }
  return 0;
}
