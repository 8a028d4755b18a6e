// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What the error tracker finds on frames of a simulated camera whose errors are known.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <Eigen/Geometry>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/acquisition/pixel_label.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/unwrap/error_tracker.hpp>
#include <tofmap/unwrap/measured_frame.hpp>
#include <tofmap/unwrap/phase_noise.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

SimulatorOptions small_camera() {
  SimulatorOptions simulation;
  simulation.width_px = 88;
  simulation.height_px = 72;
  return simulation;
}

/// A frame whose phases are NaN at both frequencies where either has no return.
DualFrequencyFrame returns_of(const SimulatedFrame& simulated) {
  DualFrequencyFrame frame = simulated.frame;
  for (Eigen::Index i = 0; i < frame.phase_a.size(); ++i) {
    if (!std::isnan(frame.phase_a.data()[i] + frame.phase_b.data()[i])) continue;
    frame.phase_a.data()[i] = frame.phase_b.data()[i] = NAN;
  }
  return frame;
}

ErrorTracker::Tracked track(ErrorTracker& tracker, const DualFrequencyFrame& frame) {
  return tracker.track(frame, PhaseSigma(frame, estimate_phase_noise(frame)));
}

ErrorTracker tracker_of(const Simulator& simulator) {
  return {beat_limits(simulator.sensor(), 0), simulator.sensor().camera};
}

/// Frames spread over the path through the scene.
std::vector<SimulatedFrame> frames_of(const Simulator& simulator, int frames) {
  std::vector<SimulatedFrame> simulated;
  const int total = *simulator.frame_count();
  for (int i = 0; i < frames; ++i) {
    simulated.push_back(simulator.simulate((2 * i + 1) * total / (2 * frames)));
  }
  return simulated;
}

/// Frames one after the other.
std::vector<SimulatedFrame> run_of(const Simulator& simulator, int first, int frames) {
  std::vector<SimulatedFrame> simulated;
  for (int i = 0; i < frames; ++i) simulated.push_back(simulator.simulate(first + i));
  return simulated;
}

/// The residuals at the true count of pixels that see one surface.
std::vector<double> true_residuals_m(const SimulatedFrame& simulated, const ImageF& phase_a,
                                     const ImageF& phase_b, const BeatLimits& limits) {
  std::vector<double> residuals_m;
  for (Eigen::Index i = 0; i < phase_a.size(); ++i) {
    if (simulated.label.data()[i] != static_cast<int>(PixelLabel::right)) continue;
    const double a = phase_a.data()[i];
    const double b = phase_b.data()[i];
    const double n = std::round(simulated.range_truth_m.data()[i] / limits.wavelength_a_m - a);
    const double residual_m =
        frequency_residual_m(limits.wavelength_a_m, limits.wavelength_b_m, a + n, b);
    if (!std::isnan(residual_m)) residuals_m.push_back(residual_m);
  }
  return residuals_m;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(ErrorTracker, FindsAnOffsetOnTheFirstFrame) {
  for (const char* scene : {"hall", "room", "flat", "corridor"}) {
  for (const double offset_b_m : {-0.1, 0.1}) {
    SimulatorOptions simulation = small_camera();
    simulation.offset_b_m = offset_b_m;
    const Simulator simulator(make_scene(scene), simulation);
    for (int i : {5, 20, 35, 60}) {
    ErrorTracker tracker = tracker_of(simulator);
    const FrameErrors errors = track(tracker, returns_of(simulator.simulate(i % *simulator.frame_count()))).errors;
    std::printf("%s %d: %.3f -> %.4f, sys %.4f flow %.2f t %.3f %.3f %.3f\n", scene, i, offset_b_m, errors.camera.offset_m(), errors.camera.systematic_m, errors.flow_px, errors.motion.translation_m.x(),errors.motion.translation_m.y(),errors.motion.translation_m.z());
    }
  }
  }
}

TEST(ErrorTracker, PredictsAPeriodicErrorAfterSomeFrames) {
  SimulatorOptions simulation = small_camera();
  simulation.periodic_a_m = 0.04;
  simulation.periodic_b_m = 0.04;
  simulation.range_noise_m = 0.003;
  for (int seed = 1; seed <= 3; ++seed) {
  simulation.errors_seed = seed;
  for (const char* scene : {"hall", "room"}) {
  const Simulator simulator(make_scene(scene), simulation);
  ErrorTracker tracker = tracker_of(simulator);
  const BeatLimits limits = beat_limits(simulator.sensor(), 0);
  int k = 0;
  for (const SimulatedFrame& simulated : frames_of(simulator, 12)) {
    const DualFrequencyFrame frame = returns_of(simulated);
    const auto tracked = track(tracker, frame);
    if (++k % 3 != 0) continue;
    auto before = true_residuals_m(simulated, frame.phase_a, frame.phase_b, limits);
    auto after = true_residuals_m(simulated, frame.phase_a, tracked.b.phase_b, limits);
    std::printf("%s %d frame %d: %.4f -> %.4f sys %.4f per %.4f\n", scene, seed, k, rms(before), rms(after), tracked.errors.camera.systematic_m, tracked.errors.camera.periodic_rms_m());
  }
  }
  }
}

TEST(ErrorTracker, FindsAnErrorThatGrowsWithDarkness) {
  SimulatorOptions simulation = small_camera();
  simulation.amplitude_error_b_m = 0.06;
  simulation.range_noise_m = 0.01;
  for (const char* scene : {"hall", "room"}) {
  const Simulator simulator(make_scene(scene), simulation);
  ErrorTracker tracker = tracker_of(simulator);
  const BeatLimits limits = beat_limits(simulator.sensor(), 0);
  for (const SimulatedFrame& simulated : frames_of(simulator, 12)) {
    const DualFrequencyFrame frame = returns_of(simulated);
    const auto tracked = track(tracker, frame);
    auto before = true_residuals_m(simulated, frame.phase_a, frame.phase_b, limits);
    auto after = true_residuals_m(simulated, frame.phase_a, tracked.b.phase_b, limits);
    std::printf("%s amp: %.4f -> %.4f med %.4f -> %.4f per decade %.4f offset %.4f\n", scene, rms(before), rms(after), median(before), median(after), tracker.camera_errors().per_decade_m(), tracker.camera_errors().offset_m());
  }
  }
}

}  // namespace
}  // namespace tofmap
