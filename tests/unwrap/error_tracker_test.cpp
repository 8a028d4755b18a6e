// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What the error tracker finds on frames of a simulated camera whose errors are known.

#include "simulated_turn.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <tofmap/core/bytes.hpp>
#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/errors/error_tracker.hpp>
#include <tofmap/unwrap/errors/measured_frame.hpp>
#include <tofmap/unwrap/errors/phase_noise.hpp>
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
Frame returns_of(const SimulatedFrame& simulated) {
  Frame frame = simulated.frame;
  for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
    if (!std::isnan(frame.phases[0].data()[i] + frame.phases[1].data()[i])) continue;
    frame.phases[0].data()[i] = frame.phases[1].data()[i] = NAN;
  }
  return frame;
}

ErrorTracker::Tracked track(ErrorTracker& tracker, const Frame& frame) {
  return tracker.track(frame, PhaseSigma(frame, estimate_phase_noise(frame)));
}

ErrorTracker tracker_of(const Simulator& simulator) {
  return {unwrap_limits(simulator.sensor(), 0).pair(0, 1), simulator.sensor().camera};
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

/// True where the pixel and its four neighbours see one plane: no edge is within reach.
bool is_smooth(const ImageF& range_m, Eigen::Index v, Eigen::Index u) {
  constexpr float flat_m = 0.01F;
  if (v < 1 || u < 1 || v + 1 >= range_m.rows() || u + 1 >= range_m.cols()) return false;
  const float across_m = range_m(v, u - 1) - 2 * range_m(v, u) + range_m(v, u + 1);
  const float along_m = range_m(v - 1, u) - 2 * range_m(v, u) + range_m(v + 1, u);
  return std::abs(across_m) < flat_m && std::abs(along_m) < flat_m;
}

/// The residuals at the true count of pixels on smooth surfaces.
std::vector<double> residuals_m(const SimulatedFrame& truth, const ImageF& phase_b,
                                const PairLimits& limits) {
  std::vector<double> residuals_m;
  for (Eigen::Index v = 0; v < phase_b.rows(); ++v) {
    for (Eigen::Index u = 0; u < phase_b.cols(); ++u) {
      if (!is_smooth(truth.range_truth_m, v, u)) continue;
      const double phase_a = truth.frame.phases[0](v, u);
      const double n = std::round(truth.range_truth_m(v, u) / limits.wavelength_a_m - phase_a);
      const double residual_m = frequency_residual_m(limits.wavelength_a_m, limits.wavelength_b_m,
                                                     phase_a + n, phase_b(v, u));
      if (!std::isnan(residual_m)) residuals_m.push_back(residual_m);
    }
  }
  return residuals_m;
}

double rms(const std::vector<double>& values) {
  double squares = 0;
  for (const double value : values) squares += value * value;
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(ErrorTracker, FindsAnOffsetOnTheFirstFrame) {
  for (const char* scene : {"hall", "room", "flat"}) {
    for (const double offset_b_m : {-0.14, -0.1, 0.1, 0.14}) {
      SimulatorOptions simulation = small_camera();
      simulation.offset_b_m = offset_b_m;
      const Simulator simulator(make_scene(scene), simulation);
      ErrorTracker tracker = tracker_of(simulator);
      const FrameErrors errors = track(tracker, returns_of(simulator.simulate(20))).errors;
      // Motion along the view up to the prior's centimetre is not told from it on one frame.
      EXPECT_NEAR(errors.camera.offset_m(), -offset_b_m, 0.012) << scene;
      EXPECT_EQ(tracker.camera_errors().frames, 1) << scene;
    }
  }
}

/// The offset after a frame with one offset of B, and many with another.
double offset_after_m(double first_offset_b_m, double offset_b_m, double& step_m) {
  SimulatorOptions simulation = small_camera();
  simulation.b_delay_share = 0;
  simulation.offset_b_m = first_offset_b_m;
  const Simulator first(make_scene("room"), simulation);
  simulation.offset_b_m = offset_b_m;
  const Simulator others(make_scene("room"), simulation);
  ErrorTracker tracker = tracker_of(first);
  step_m = residual_step_m(unwrap_limits(first.sensor(), 0).pair(0, 1));
  track(tracker, returns_of(first.simulate(0)));
  for (int i = 1; i < 20; ++i) track(tracker, returns_of(others.simulate(i)));
  return tracker.camera_errors().offset_m();
}

TEST(ErrorTracker, TakesTheSmallerOfTwoOffsetsAStepApart) {
  // Frames lead to an offset beyond half of a step. One count more in all pixels explains residuals
  // with a smaller one.
  double step_m = 0;
  const double offset_m = offset_after_m(0.14, 0.2, step_m);
  ASSERT_GT(step_m / 2, 0.14);
  ASSERT_LT(step_m / 2, 0.2);
  EXPECT_NEAR(offset_m, step_m - 0.2, 0.012);
}

TEST(ErrorTracker, KeepsALargeOffsetWhereSurfacesAreTooNearForTheSmaller) {
  // The smaller offset would take one count less in all pixels, but many have none to lose.
  double step_m = 0;
  const double offset_m = offset_after_m(-0.14, -0.2, step_m);
  EXPECT_NEAR(offset_m, 0.2, 0.012);
}

TEST(ErrorTracker, CorrectsNothingWhereThereIsNoError) {
  for (const char* scene : {"hall", "room", "flat"}) {
    SimulatorOptions simulation = small_camera();
    simulation.b_delay_share = 0;
    const Simulator simulator(make_scene(scene), simulation);
    const double wavelength_b_m = unwrap_limits(simulator.sensor(), 0).wavelengths_m[1];
    ErrorTracker tracker = tracker_of(simulator);
    std::vector<double> corrections_m;
    for (const SimulatedFrame& simulated : frames_of(simulator, 12)) {
      const Frame frame = returns_of(simulated);
      const ErrorTracker::Tracked tracked = track(tracker, frame);
      for (Eigen::Index i = 0; i < frame.phases[1].size(); ++i) {
        const double change = tracked.b.phase_b.data()[i] - frame.phases[1].data()[i];
        if (std::isnan(change) || tracked.b.sigma_b_cycles.data()[i] > 1) continue;
        corrections_m.push_back(std::remainder(change, 1) * wavelength_b_m);
      }
    }
    // The noise of a pixel's residual is 2 cm and more: a fifth of it is what some hundred
    // independent samples a frame leave.
    EXPECT_LT(rms(corrections_m), 0.005) << scene;
    EXPECT_NEAR(tracker.camera_errors().offset_m(), 0, 0.005) << scene;
    EXPECT_LT(tracker.camera_errors().systematic_m, 0.005) << scene;
  }
}

TEST(ErrorTracker, PredictsAPeriodicErrorAfterSomeFrames) {
  for (const int seed : {1, 2}) {
    SimulatorOptions simulation = small_camera();
    simulation.periodic_a_m = 0.04;
    simulation.periodic_b_m = 0.04;
    simulation.errors_seed = seed;
    simulation.range_noise_m = 0.003;  // so that what is left of the residual is not noise
    const Simulator simulator(make_scene("hall"), simulation);
    const PairLimits limits = unwrap_limits(simulator.sensor(), 0).pair(0, 1);
    ErrorTracker tracker = tracker_of(simulator);
    std::vector<double> before_m;
    std::vector<double> after_m;
    int index = 0;
    for (const SimulatedFrame& simulated : frames_of(simulator, 12)) {
      const ErrorTracker::Tracked tracked = track(tracker, returns_of(simulated));
      if (++index <= 6) continue;
      std::ranges::copy(residuals_m(simulated, simulated.frame.phases[1], limits),
                        std::back_inserter(before_m));
      std::ranges::copy(residuals_m(simulated, tracked.b.phase_b, limits),
                        std::back_inserter(after_m));
    }
    EXPECT_GT(rms(before_m), 0.015) << "the error is there";
    EXPECT_LT(rms(after_m), 0.01) << seed;
  }
}

TEST(ErrorTracker, PredictsAnErrorThatGrowsWithDarkness) {
  SimulatorOptions simulation = small_camera();
  simulation.amplitude_error_b_m = 0.09;  // 3 cm a decade, and of B: A's excess falls with darkness
  simulation.range_noise_m = 0.005;
  const Simulator simulator(make_scene("hall"), simulation);
  const PairLimits limits = unwrap_limits(simulator.sensor(), 0).pair(0, 1);
  ErrorTracker tracker = tracker_of(simulator);
  std::vector<double> before_m;
  std::vector<double> after_m;
  int index = 0;
  for (const SimulatedFrame& simulated : frames_of(simulator, 12)) {
    const ErrorTracker::Tracked tracked = track(tracker, returns_of(simulated));
    if (++index <= 6) continue;
    std::ranges::copy(residuals_m(simulated, simulated.frame.phases[1], limits),
                      std::back_inserter(before_m));
    std::ranges::copy(residuals_m(simulated, tracked.b.phase_b, limits),
                      std::back_inserter(after_m));
  }
  EXPECT_GT(rms(before_m), 0.04);
  EXPECT_LT(rms(after_m), 0.009);
  // Of one surface after another amplitude goes with range, and periodic errors share what it
  // explains: the slope is found to a third.
  EXPECT_NEAR(tracker.camera_errors().per_decade_m(), 0.03, 0.01);
}

/// Ranges to a floor and walls, and the light that comes back from them.
class Corner {
 public:
  const CameraModel camera{
      .width_px = 88, .height_px = 72, .fx_px = 64, .fy_px = 64, .cx_px = 43.5, .cy_px = 35.5};
  const PixelRays rays = pixel_rays(camera);

  /// The range along a ray of the world, and the amplitude of its light.
  struct Seen {
    double range_m;
    double amplitude;
  };
  Seen look(const Eigen::Vector3d& origin, const Eigen::Vector3d& ray) const {
    Seen seen{1e9, 0};
    const auto hit = [&](const Eigen::Vector3d& normal, double distance_m) {
      const double toward = normal.dot(ray);
      const double range_m = (distance_m - normal.dot(origin)) / toward;
      if (toward <= 0 || range_m >= seen.range_m) return;
      const Eigen::Vector3d point = origin + range_m * ray;
      const double texture = 1 + 0.4 * std::sin(4 * point.x() + 1) * std::sin(4 * point.y());
      seen = {range_m, 3000 * texture * toward / (range_m * range_m)};
    };
    hit(Eigen::Vector3d::UnitY(), 1.5);
    hit(Eigen::Vector3d(0.6, 0, 0.8), 5);
    hit(Eigen::Vector3d(-0.8, 0, 0.6), 4);
    hit(Eigen::Vector3d(0, -0.8, 0.6), 4);
    return seen;
  }

  ImageF ranges_from(const Pose& world_from_camera) const {
    return image_from(world_from_camera, [](const Seen& seen) { return seen.range_m; });
  }

  /// A frame without noise, A exposed at the origin and B after this motion.
  Frame frame_of(const Pose& a_from_b) const {
    const auto phase = [&](const Pose& pose, double wavelength_m) {
      return image_from(pose, [&](const Seen& seen) {
        return seen.range_m / wavelength_m - std::floor(seen.range_m / wavelength_m);
      });
    };
    const auto amplitude = [&](const Pose& pose) {
      return image_from(pose, [](const Seen& seen) { return seen.amplitude; });
    };
    Frame frame = blank_frame(2);
    frame.phases[0] = phase(Pose::Identity(), limits.wavelength_a_m);
    frame.phases[1] = phase(a_from_b, limits.wavelength_b_m);
    frame.amplitudes[0] = amplitude(Pose::Identity());
    frame.amplitudes[1] = amplitude(a_from_b);
    return frame;
  }

  const PairLimits limits = unwrap_limits({camera, {29e6, 31e6}}, 20).pair(0, 1);

 private:
  template <class Value>
  ImageF image_from(const Pose& pose, const Value& value) const {
    ImageF image(rays.x.rows(), rays.x.cols());
    for (Eigen::Index i = 0; i < image.size(); ++i) {
      const Eigen::Vector3d ray(rays.x.data()[i], rays.y.data()[i], rays.z.data()[i]);
      image.data()[i] = static_cast<float>(value(look(pose.translation(), pose.linear() * ray)));
    }
    return image;
  }
};

/// The noise that frames without any are said to have: 3 mm.
PhaseSigma said_sigma(const Frame& frame) {
  const ImageF sigma = frame.phases[0].isNaN().select(
      ImageF::Constant(frame.phases[0].rows(), frame.phases[0].cols(), NAN), 6e-4F);
  PhaseSigma both;
  both.cycles = {sigma, sigma};
  return both;
}

Pose pose_of(const Eigen::Vector3d& translation_m, const Eigen::Vector3d& rotation_rad) {
  Pose pose = Pose::Identity();
  pose.translation() = translation_m;
  const double angle = rotation_rad.norm();
  if (angle > 0) pose.linear() = Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
  return pose;
}

/// A tracker that has seen the camera stand still, and knows that its frequencies agree.
ErrorTracker acquainted(const Corner& corner) {
  ErrorTracker tracker(corner.limits, corner.camera);
  const Frame still = corner.frame_of(Pose::Identity());
  for (int i = 0; i < 4; ++i) tracker.track(still, said_sigma(still));
  tracker.forget_last_frame();
  return tracker;
}

TEST(ErrorTracker, FindsTheMotionBetweenTheExposures) {
  struct Motion {
    Eigen::Vector3d translation_m;
    Eigen::Vector3d rotation_rad;
  };
  const Corner corner;
  for (const auto& [translation_m, rotation_rad] :
       {Motion{{0.004, -0.003, 0.009}, {0.002, -0.004, 0.001}},
        Motion{{0.02, -0.01, 0.05}, {0.004, -0.008, 0.003}},
        Motion{{0.03, 0.01, 0.08}, {-0.01, 0.06, 0.01}}}) {
    ErrorTracker tracker = acquainted(corner);
    const Frame frame = corner.frame_of(pose_of(translation_m, rotation_rad));
    const ErrorTracker::Tracked tracked = tracker.track(frame, said_sigma(frame));
    const ExposureMotion& motion = tracked.errors.motion;
    // A motion of a centimetre is likely by itself, so a third of it stays open; of a larger one a
    // twentieth.
    EXPECT_LT((motion.translation_m - translation_m).norm(), 0.004);
    EXPECT_LT((motion.rotation_rad - rotation_rad).norm(), 0.1 * rotation_rad.norm() + 0.0003);
  }
}

TEST(ErrorTracker, BringsBBackToWhereAWasExposed) {
  const Corner corner;
  for (const double rotation_rad : {0.004, 0.06}) {
    ErrorTracker tracker = acquainted(corner);
    const Frame frame =
        corner.frame_of(pose_of({0.01, 0, 0.03 + rotation_rad}, {0, rotation_rad, 0}));
    const ErrorTracker::Tracked tracked = tracker.track(frame, said_sigma(frame));
    SimulatedFrame truth;
    truth.frame = frame;
    truth.range_truth_m = corner.ranges_from(Pose::Identity());
    ImageF seen_b = tracked.b.phase_b;
    seen_b = (tracked.b.sigma_b_cycles < 1).select(seen_b, NAN);
    std::vector<double> left_m = residuals_m(truth, seen_b, corner.limits);
    std::vector<double> without_m = residuals_m(truth, frame.phases[1], corner.limits);
    EXPECT_LT(rms(left_m), 0.2 * rms(without_m)) << rotation_rad;
    // Going 9 cm ahead and turning takes a fifth of the surface out of B's image.
    EXPECT_GT(static_cast<double>(left_m.size()), 0.75 * static_cast<double>(without_m.size()));
  }
}

TEST(ErrorTracker, FindsTheWholeMotionWhereSlopesAreNoisy) {
  // Noise in slopes makes turns look smaller than they are, if nothing averages it.
  SimulatorOptions simulation;
  simulation.range_noise_m = 0.05;
  simulation.b_delay_share = 0.5;
  simulation.max_rotation_deg = 3;
  const Simulator simulator(make_scene("room"), simulation);
  ErrorTracker tracker = tracker_of(simulator);
  double found_rad = 0;
  double true_rad = 0;
  for (int i = 20; i < 28; ++i) {
    const SimulatedFrame frame = simulator.simulate(i);
    const Eigen::Vector3d rotation_rad = test::turn_between(frame, simulator.simulate(i + 1));
    true_rad += 0.5 * rotation_rad.norm();
    found_rad +=
        track(tracker, returns_of(frame)).errors.motion.rotation_rad.dot(rotation_rad.normalized());
  }
  ASSERT_GT(true_rad / 8, 0.005);
  EXPECT_NEAR(found_rad / true_rad, 1, 0.15);
}

TEST(ErrorTracker, KnowsNothingOfBWhereItsImageEnds) {
  const Corner corner;
  ErrorTracker tracker = acquainted(corner);
  const Pose a_from_b = pose_of(Eigen::Vector3d::Zero(), {0, 0.1, 0});
  const Frame frame = corner.frame_of(a_from_b);
  const ErrorTracker::Tracked tracked = tracker.track(frame, said_sigma(frame));
  const ImageF range_m = corner.ranges_from(Pose::Identity());
  int outside = 0;
  int outside_unseen = 0;
  int inside = 0;
  int inside_seen = 0;
  for (Eigen::Index v = 0; v < range_m.rows(); ++v) {
    for (Eigen::Index u = 0; u < range_m.cols(); ++u) {
      const Eigen::Vector3d point =
          range_m(v, u) *
          Eigen::Vector3d(corner.rays.x(v, u), corner.rays.y(v, u), corner.rays.z(v, u));
      const auto pixel = project(corner.camera, a_from_b.inverse() * point);
      ASSERT_TRUE(pixel);
      const bool unseen = tracked.b.sigma_b_cycles(v, u) == MatchedExposure::unseen_sigma_cycles;
      // A pixel on both sides of the border is left to the error of the motion.
      if (pixel->x() < -1.5) {
        ++outside;
        outside_unseen += unseen ? 1 : 0;
      } else if (pixel->x() > 0.5 && pixel->y() > 0.5 && pixel->y() < 70.5) {
        ++inside;
        inside_seen += unseen ? 0 : 1;
      }
    }
  }
  ASSERT_GT(outside, 300);
  EXPECT_EQ(outside_unseen, outside);
  EXPECT_GT(inside_seen, 0.95 * inside);
}

SimulatorOptions switching_camera() {
  SimulatorOptions simulation = small_camera();
  simulation.b_delay_share = 1;
  simulation.max_translation_m = 0.1;
  simulation.max_rotation_deg = 6;
  return simulation;
}

/// Three runs of twelve frames through the hall, each looked ahead at as the program does.
double wrong_wraps_percent(const SimulatorOptions& simulation, const UnwrapOptions& options) {
  const Simulator simulator(make_scene("hall"), simulation);
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(0);
  Unwrapper unwrapper(simulator.sensor(), options);
  double wrong = 0;
  double all = 0;
  for (const int first : {0, 20, 40}) {
    const std::vector<SimulatedFrame> run = run_of(simulator, first, 12);
    std::vector<Frame> ahead;
    for (std::size_t i = 0; i < FrameMeasurer::frames_ahead; ++i) ahead.push_back(run[i].frame);
    FrameMeasurer measurer(simulator.sensor(), options);
    measurer.look_ahead(ahead);
    for (const SimulatedFrame& simulated : run) {
      const RangeImage image = unwrapper.unwrap(measurer.measure(simulated.frame)).image;
      for (Eigen::Index i = 0; i < image.reason.size(); ++i) {
        const double error_m = image.range_m.data()[i] - simulated.range_truth_m.data()[i];
        if (std::isnan(error_m)) continue;
        all += 1;
        wrong += std::abs(error_m) > wavelength_m / 2 ? 1 : 0;
      }
    }
  }
  return 100 * wrong / all;
}

TEST(ErrorTracker, UnwrapsACameraThatSwitchesFrequencyFromFrameToFrame) {
  SimulatorOptions at_once = switching_camera();
  at_once.b_delay_share = 0;
  const double at_once_percent = wrong_wraps_percent(at_once, {});
  // What lies outside B's image has only its neighbours to tell its count.
  EXPECT_LE(wrong_wraps_percent(switching_camera(), {}), 1.3 * at_once_percent);
  UnwrapOptions as_it_comes;
  as_it_comes.systematic_errors = false;
  EXPECT_GT(wrong_wraps_percent(switching_camera(), as_it_comes), 10 * at_once_percent)
      << "the motion matters";
}

TEST(ErrorTracker, ExpectsACameraThatWasLateToBeLate) {
  const Simulator simulator(make_scene("hall"), switching_camera());
  ErrorTracker tracker = tracker_of(simulator);
  int late = 0;
  for (const SimulatedFrame& frame : run_of(simulator, 20, 6)) {
    track(tracker, returns_of(frame));
    EXPECT_EQ(tracker.camera_errors().late_frames, ++late);
  }
  SimulatorOptions prompt;
  const Simulator at_once(make_scene("hall"), prompt);
  ErrorTracker other = tracker_of(at_once);
  for (const SimulatedFrame& frame : run_of(at_once, 20, 3)) track(other, returns_of(frame));
  EXPECT_EQ(other.camera_errors().late_frames, 0);
}

TEST(ErrorTracker, ExpectsACameraToGoOnAsItWent) {
  // It moves sideways and turns towards what it passes: a wall that stays where it is in the image
  // looks as if nothing moved at all.
  const Simulator simulator(make_scene("room"), switching_camera());
  ErrorTracker tracker = tracker_of(simulator);
  const std::vector<SimulatedFrame> run = run_of(simulator, 96, 24);
  for (std::size_t i = 0; i + 1 < run.size(); ++i) {
    const Eigen::Vector3d found_rad = track(tracker, returns_of(run[i])).errors.motion.rotation_rad;
    EXPECT_LT((found_rad - test::turn_between(run[i], run[i + 1])).norm(), 0.01) << i;
  }
}

/// The same number of NaNs, and the same bits.
bool is_same(const ImageF& one, const ImageF& other) {
  return one.rows() == other.rows() && one.cols() == other.cols() &&
         (one.size() == 0 ||
          std::memcmp(one.data(), other.data(),
                      sizeof(float) * static_cast<std::size_t>(one.size())) == 0);
}

bool is_same(const ErrorTracker::Tracked& one, const ErrorTracker::Tracked& other) {
  return is_same(one.b.phase_b, other.b.phase_b) &&
         is_same(one.b.amplitude_b, other.b.amplitude_b) &&
         is_same(one.b.sigma_b_cycles, other.b.sigma_b_cycles) &&
         one.errors.camera.coefficient_m == other.errors.camera.coefficient_m &&
         one.errors.camera.systematic_m == other.errors.camera.systematic_m &&
         one.errors.motion.translation_m == other.errors.motion.translation_m &&
         one.errors.motion.rotation_rad == other.errors.motion.rotation_rad;
}

std::string state_of(const ErrorTracker& tracker) {
  ByteWriter writer;
  tracker.save(writer);
  return writer.take();
}

TEST(ErrorTracker, GoesOnFromASavedStateToTheSameBits) {
  const Simulator simulator(make_scene("hall"), switching_camera());
  const std::vector<SimulatedFrame> frames = run_of(simulator, 20, 5);
  ErrorTracker kept = tracker_of(simulator);
  for (int i = 0; i < 4; ++i) track(kept, returns_of(frames[static_cast<std::size_t>(i)]));
  const std::string state = state_of(kept);
  ErrorTracker resumed = tracker_of(simulator);
  ByteReader reader(state);
  resumed.load(reader);
  const ErrorTracker::Tracked expected = track(kept, returns_of(frames.back()));
  EXPECT_TRUE(expected.errors.used_last_b) << "so that the last frame is part of the state";
  EXPECT_TRUE(is_same(track(resumed, returns_of(frames.back())), expected));
  ErrorTracker fresh = tracker_of(simulator);
  EXPECT_FALSE(is_same(track(fresh, returns_of(frames.back())), expected))
      << "what is saved matters";
  EXPECT_EQ(state_of(kept), state_of(resumed));
}

TEST(ErrorTracker, RefusesADamagedState) {
  const Corner corner;
  const std::string whole = state_of(acquainted(corner));
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
    ByteReader cut(std::string_view(whole).substr(0, size));
    ErrorTracker tracker(corner.limits, corner.camera);
    EXPECT_THROW(tracker.load(cut), InputError) << size;
  }
}

TEST(ErrorTracker, ForgetsTheLastFrameButNotTheCamera) {
  const Simulator simulator(make_scene("hall"), switching_camera());
  const std::vector<SimulatedFrame> frames = run_of(simulator, 20, 4);
  ErrorTracker tracker = tracker_of(simulator);
  for (int i = 0; i < 3; ++i) track(tracker, returns_of(frames[static_cast<std::size_t>(i)]));
  ErrorTracker forgetting = tracker;
  forgetting.forget_last_frame();
  EXPECT_EQ(forgetting.camera_errors().coefficient_m, tracker.camera_errors().coefficient_m);
  EXPECT_EQ(forgetting.camera_errors().frames, 3);
  EXPECT_TRUE(track(tracker, returns_of(frames.back())).errors.used_last_b);
  EXPECT_FALSE(track(forgetting, returns_of(frames.back())).errors.used_last_b);
}

TEST(ErrorTracker, TakesMotionForAnOffsetWhereTheCameraIsUnknown) {
  SimulatorOptions simulation = small_camera();
  simulation.offset_b_m = -0.08;
  const Simulator simulator(make_scene("hall"), simulation);
  ErrorTracker tracker(unwrap_limits(simulator.sensor(), 0).pair(0, 1), CameraModel());
  const FrameErrors errors = track(tracker, returns_of(simulator.simulate(20))).errors;
  EXPECT_NEAR(errors.camera.offset_m(), 0.08, 0.015);
  EXPECT_EQ(errors.motion.translation_m.norm(), 0);
  EXPECT_EQ(errors.motion.rotation_rad.norm(), 0);
  EXPECT_EQ(errors.flow_px, 0);
}

TEST(ErrorTracker, NeedsNoAmplitudes) {
  SimulatorOptions simulation = small_camera();
  simulation.offset_b_m = -0.08;
  simulation.range_noise_m = 0.005;
  const Simulator simulator(make_scene("hall"), simulation);
  Frame frame = returns_of(simulator.simulate(20));
  frame.amplitudes[0].resize(0, 0);
  frame.amplitudes[1].resize(0, 0);
  ErrorTracker tracker = tracker_of(simulator);
  const ErrorTracker::Tracked tracked = track(tracker, frame);
  EXPECT_NEAR(tracked.errors.camera.offset_m(), 0.08, 0.015);
  EXPECT_EQ(tracked.errors.camera.amplitude_gain, 1);
  EXPECT_EQ(tracked.b.amplitude_b.size(), 0);
  const auto seen = (tracked.b.sigma_b_cycles < 1).count();
  EXPECT_GT(seen, 0.8 * static_cast<double>(frame.phases[0].size())) << "all but edges";
}

TEST(ErrorTracker, KnowsNothingOfAFrameWithoutReturns) {
  const Corner corner;
  ErrorTracker tracker = acquainted(corner);
  const CameraErrors before = tracker.camera_errors();
  Frame dark = corner.frame_of(Pose::Identity());
  dark.phases[0].setConstant(NAN);
  dark.phases[1].setConstant(NAN);
  const ErrorTracker::Tracked tracked = tracker.track(dark, said_sigma(dark));
  EXPECT_EQ(tracked.errors.pixels, 0);
  EXPECT_EQ(tracked.errors.camera.coefficient_m, before.coefficient_m);
  EXPECT_EQ(tracker.camera_errors().frames, before.frames);
  EXPECT_TRUE(tracked.b.phase_b.isNaN().all());
  EXPECT_TRUE((tracked.b.sigma_b_cycles == MatchedExposure::unseen_sigma_cycles).all());
}

TEST(ErrorTracker, LeavesMissingPixelsOutAndEveryOtherPhaseWithinACycle) {
  const Simulator simulator(make_scene("hall"), switching_camera());
  ErrorTracker tracker = tracker_of(simulator);
  std::mt19937 random(3);
  for (const SimulatedFrame& simulated : run_of(simulator, 20, 3)) {
    Frame frame = returns_of(simulated);
    for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
      if (random() % 3 == 0) frame.phases[0].data()[i] = frame.phases[1].data()[i] = NAN;
    }
    const ErrorTracker::Tracked tracked = track(tracker, frame);
    EXPECT_TRUE((tracked.b.phase_b.isNaN() == frame.phases[0].isNaN()).all());
    for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
      if (std::isnan(frame.phases[0].data()[i])) continue;
      const float phase = tracked.b.phase_b.data()[i];
      ASSERT_TRUE(phase >= 0 && phase < 1) << phase;
      ASSERT_GT(tracked.b.sigma_b_cycles.data()[i], 0);
      ASSERT_GT(tracked.b.amplitude_b.data()[i], 0);
    }
  }
}

TEST(ErrorTracker, LeavesAFrameOfOneRowOrColumnAsItIs) {
  const Corner corner;
  const Frame whole = corner.frame_of(Pose::Identity());
  for (const auto& [rows, cols] : {std::pair{1, 88}, {72, 1}, {1, 1}, {2, 2}}) {
    CameraModel camera = corner.camera;
    camera.width_px = cols;
    camera.height_px = rows;
    Frame frame = blank_frame(2);
    frame.phases[0] = whole.phases[0].topLeftCorner(rows, cols);
    frame.phases[1] = whole.phases[1].topLeftCorner(rows, cols);
    frame.amplitudes[0] = whole.amplitudes[0].topLeftCorner(rows, cols);
    frame.amplitudes[1] = whole.amplitudes[1].topLeftCorner(rows, cols);
    for (const CameraModel& known : {camera, CameraModel()}) {
      ErrorTracker tracker(corner.limits, known);
      const ErrorTracker::Tracked tracked = tracker.track(frame, said_sigma(frame));
      const ImageF change = tracked.b.phase_b - frame.phases[1];
      EXPECT_LT((change - change.round()).abs().maxCoeff(), 1e-5) << rows << " x " << cols;
      EXPECT_LT(tracked.b.sigma_b_cycles.maxCoeff(), 1) << rows << " x " << cols;
    }
  }
}

TEST(ErrorTracker, GivesTheSameBitsBesideOthers) {
  const Simulator simulator(make_scene("hall"), switching_camera());
  const std::vector<SimulatedFrame> frames = run_of(simulator, 20, 4);
  const auto last_of = [&] {
    ErrorTracker tracker = tracker_of(simulator);
    ErrorTracker::Tracked tracked;
    for (const SimulatedFrame& simulated : frames) tracked = track(tracker, returns_of(simulated));
    return tracked;
  };
  const ErrorTracker::Tracked alone = last_of();
  std::vector<ErrorTracker::Tracked> beside(3);
  std::vector<std::thread> threads;
  for (ErrorTracker::Tracked& tracked : beside) {
    threads.emplace_back([&tracked, &last_of] { tracked = last_of(); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const ErrorTracker::Tracked& tracked : beside) EXPECT_TRUE(is_same(tracked, alone));
}

TEST(FrameMeasurer, KnowsTheCameraFromTheFirstFrameOnAfterLookingAhead) {
  SimulatorOptions simulation = small_camera();
  simulation.offset_b_m = -0.08;
  const Simulator simulator(make_scene("hall"), simulation);
  std::vector<Frame> frames;
  for (const SimulatedFrame& simulated : run_of(simulator, 20, FrameMeasurer::frames_ahead)) {
    frames.push_back(simulated.frame);
  }
  FrameMeasurer measurer(simulator.sensor(), {});
  measurer.look_ahead(frames);
  const MeasuredFrame first = measurer.measure(frames.front());
  EXPECT_EQ(first.errors[1].camera.frames, FrameMeasurer::frames_ahead + 1);
  EXPECT_NEAR(first.errors[1].camera.offset_m(), 0.08, 0.006);
}

TEST(FrameMeasurer, LeavesBAsItIsForMethodsThatDoNotCompareFrequencies) {
  SimulatorOptions simulation = small_camera();
  simulation.offset_b_m = -0.08;
  const Simulator simulator(make_scene("hall"), simulation);
  const Frame frame = returns_of(simulator.simulate(20));
  for (const char* method : {"none", "pixel", "single", "paper", "jump", "joint"}) {
    UnwrapOptions options;
    options.method = find_named<UnwrapMethod>(method).value();
    const bool compares = method == std::string("jump") || method == std::string("joint");
    const MeasuredFrame measured = FrameMeasurer(simulator.sensor(), options).measure(frame);
    EXPECT_EQ(is_same(measured.returns.phases[1], frame.phases[1]), !compares) << method;
    EXPECT_EQ(measured.residual_sigma_m[1] > 0, compares) << method;
    options.systematic_errors = false;
    const MeasuredFrame noise_alone = FrameMeasurer(simulator.sensor(), options).measure(frame);
    EXPECT_TRUE(is_same(noise_alone.returns.phases[1], frame.phases[1])) << method;
    EXPECT_EQ(noise_alone.residual_sigma_m[1], 0) << method;
  }
}

}  // namespace
}  // namespace tofmap
