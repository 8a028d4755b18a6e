// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sample_scenes.hpp"
#include "support/sample_frames.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <omp.h>
#include <support/temporary_folder.hpp>

#include <tofmap/core/error.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

/// Without noise, one ray a pixel, A and B at once: every step away from this is one test's.
SimulatorOptions plain_options() {
  SimulatorOptions options;
  options.range_noise_m = 0;
  options.subpixels = 1;
  options.b_delay_share = 0;
  options.frames = 2;
  return options;
}

/// Signed difference of two phases on the circle, cycles.
double phase_difference(double a, double b) { return a - b - std::round(a - b); }

/// The largest difference between the phases and what the ranges give, cycles.
double largest_phase_error(const ImageF& phase, const ImageF& range_m, double wavelength_m) {
  double largest = 0;
  for (Eigen::Index i = 0; i < phase.size(); ++i) {
    const double expected = range_m.data()[i] / wavelength_m;
    largest = std::max(largest, std::abs(phase_difference(phase.data()[i], expected)));
  }
  return largest;
}

TEST(Simulator, WithoutNoisePhasesAreTrueRangesModuloTheWavelengths) {
  const Simulator simulator(make_scene("wall"), plain_options());
  const SimulatedFrame simulated = simulator.simulate(0);
  const Modulation& modulation = simulator.sensor().modulation;
  ASSERT_FALSE(simulated.range_truth_m.isNaN().any());
  // Rays are cast in single precision: some 1e-6 of 10 m.
  constexpr double tolerance = 5e-6;
  EXPECT_LT(largest_phase_error(simulated.frame.phases[0], simulated.range_truth_m,
                                modulation.wavelength_m(0)),
            tolerance);
  EXPECT_LT(largest_phase_error(simulated.frame.phases[1], simulated.range_truth_m,
                                modulation.wavelength_m(1)),
            tolerance);
}

TEST(Simulator, SubpixelRaysLeaveSmoothSurfacesInPlace) {
  SimulatorOptions options = plain_options();
  options.subpixels = 4;
  const Simulator simulator(test::facing_wall_scene(4, 0.5), options);
  const SimulatedFrame simulated = simulator.simulate(0);
  // Ranges curve by about the pixel's square over twice the range: below a tenth of a millimetre.
  EXPECT_LT(largest_phase_error(simulated.frame.phases[0], simulated.range_truth_m,
                                simulator.sensor().modulation.wavelength_m(0)),
            1e-4 / 5.17);
}

TEST(Simulator, TruthIsRadialAlongTheDistortedRays) {
  SimulatorOptions options = plain_options();
  options.distortion_k1 = -0.15;
  options.distortion_p1 = 0.01;
  const Simulator simulator(test::facing_wall_scene(4, 0.5), options);
  const SimulatedFrame simulated = simulator.simulate(0);
  const PixelRays rays = pixel_rays(simulator.sensor().camera);
  // A wall that faces the camera has one z-depth.
  EXPECT_LT((depth_from_range(simulated.range_truth_m, rays) - 4).abs().maxCoeff(), 1e-4F);
}

TEST(Simulator, AmplitudeFallsWithTheSquareOfRangeAndTheCosineOfIncidence) {
  for (const double wall_m : {2.0, 6.0}) {
    const Simulator simulator(test::facing_wall_scene(wall_m, 0.4), plain_options());
    const SimulatedFrame simulated = simulator.simulate(0);
    const ImageF& range_m = simulated.range_truth_m;
    const ImageF cosine = static_cast<float>(wall_m) / range_m;
    const ImageF expected = static_cast<float>(amplitude_unit * 0.4) * cosine / range_m.square();
    const ImageF ratio = simulated.frame.amplitudes[0] / expected;
    EXPECT_LT((ratio - 1).abs().maxCoeff(), 1e-4F) << wall_m;
    EXPECT_LT((simulated.frame.amplitudes[1] / expected - 1).abs().maxCoeff(), 1e-4F) << wall_m;
  }
}

TEST(Simulator, AmplitudeEndsWhereTheSensorSaturates) {
  const Simulator simulator(test::facing_wall_scene(0.2, 1.0), plain_options());
  EXPECT_EQ(simulator.simulate(0).frame.amplitudes[0].maxCoeff(), 65535);
}

/// Root mean square of (phase error × amplitude) over the pixels of a range of amplitudes; if
/// phase noise goes as 1 / amplitude it is the noise strength in each.
struct NoiseSum {
  double squares = 0;
  int count = 0;
  double rms() const { return std::sqrt(squares / count); }
};

TEST(Simulator, RangeNoiseAtTheReferenceIsTheOption) {
  SimulatorOptions options = plain_options();
  options.range_noise_m = 0.02;
  options.frames = 20;
  const Simulator simulator(test::facing_wall_scene(5, 0.5), options);
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(0);
  NoiseSum range_noise;
  for (int frame = 0; frame < 20; ++frame) {
    const SimulatedFrame simulated = simulator.simulate(frame);
    // The image's middle, where range and incidence are those of the reference within 0.5 %.
    for (int v = 66; v < 78; ++v) {
      for (int u = 82; u < 94; ++u) {
        const double truth = simulated.range_truth_m(v, u) / wavelength_m;
        const double error =
            wavelength_m * phase_difference(simulated.frame.phases[0](v, u), truth);
        range_noise.squares += error * error;
        ++range_noise.count;
      }
    }
  }
  // 2880 samples: the estimate itself scatters by 1.3 %; four times that.
  EXPECT_NEAR(range_noise.rms() / 0.02, 1, 0.05);
}

TEST(Simulator, PhaseNoiseGoesAsOneOverAmplitude) {
  SimulatorOptions options = plain_options();
  options.range_noise_m = 0.02;
  const Simulator simulator(make_scene("wall"), options);
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(0);
  const SimulatorOptions quiet = plain_options();
  const ImageF signal = Simulator(make_scene("wall"), quiet).simulate(0).frame.amplitudes[0];
  NoiseSum weak;
  NoiseSum strong;
  const SimulatedFrame simulated = simulator.simulate(0);
  for (Eigen::Index i = 0; i < signal.size(); ++i) {
    const double amplitude = signal.data()[i];
    if (amplitude < 5 * simulator.noise_sigma()) continue;  // below, phase noise is not Gaussian
    const double truth = simulated.range_truth_m.data()[i] / wavelength_m;
    const double error_rad =
        2 * std::numbers::pi * phase_difference(simulated.frame.phases[0].data()[i], truth);
    NoiseSum& sum = amplitude < 30 * simulator.noise_sigma() ? weak : strong;
    sum.squares += error_rad * error_rad * amplitude * amplitude;
    ++sum.count;
  }
  ASSERT_GT(weak.count, 2000);
  ASSERT_GT(strong.count, 2000);
  // The estimates scatter by up to 1.6 %; the linear law itself is off by up to 2 % at 5 σ.
  EXPECT_NEAR(weak.rms() / simulator.noise_sigma(), 1, 0.06);
  EXPECT_NEAR(strong.rms() / simulator.noise_sigma(), 1, 0.06);
}

/// Noise across (radial) and along (tangential) the circle of the phase, in units of its
/// strength: independent of each other, between A and B, and standard normal.
TEST(Simulator, NoiseIsComplexGaussianAndIndependentBetweenImages) {
  SimulatorOptions options = plain_options();
  options.range_noise_m = 0.02;
  const Simulator simulator(test::facing_wall_scene(1.5, 0.9), options);
  const SimulatedFrame noisy = simulator.simulate(0);
  const SimulatedFrame clean =
      Simulator(test::facing_wall_scene(1.5, 0.9), plain_options()).simulate(0);
  const auto tangential = [&](const ImageF& phase, const ImageF& truth, const ImageF& amplitude) {
    const ImageF turns = phase - truth - (phase - truth).round();
    return ImageF(turns * amplitude *
                  static_cast<float>(2 * std::numbers::pi / simulator.noise_sigma()));
  };
  const ImageF radial_a = (noisy.frame.amplitudes[0] - clean.frame.amplitudes[0]) /
                          static_cast<float>(simulator.noise_sigma());
  const ImageF tangential_a =
      tangential(noisy.frame.phases[0], clean.frame.phases[0], clean.frame.amplitudes[0]);
  const ImageF tangential_b =
      tangential(noisy.frame.phases[1], clean.frame.phases[1], clean.frame.amplitudes[1]);
  // 25 344 pixels: means scatter by 0.0063, squares by 0.0089, fourth powers by 0.06.
  for (const ImageF& noise : {radial_a, tangential_a, tangential_b}) {
    EXPECT_NEAR(noise.mean(), 0, 0.03);
    EXPECT_NEAR(noise.square().mean(), 1, 0.04);
    EXPECT_NEAR(noise.square().square().mean(), 3, 0.25);
  }
  EXPECT_NEAR((radial_a * tangential_a).mean(), 0, 0.03);
  EXPECT_NEAR((tangential_a * tangential_b).mean(), 0, 0.03);
  const Eigen::Index cols = radial_a.cols();
  EXPECT_NEAR((radial_a.leftCols(cols - 1) * radial_a.rightCols(cols - 1)).mean(), 0, 0.03);
}

int count_between(const ImageF& phase, double low, double high) {
  return static_cast<int>(
      (phase > static_cast<float>(low) && phase < static_cast<float>(high)).count());
}

TEST(Simulator, PixelsOnAnEdgeFlyBetweenBothSurfaces) {
  SimulatorOptions options = plain_options();
  options.subpixels = 4;
  // From 2.7 m (the image's corner on the near wall) to the far one, in cycles of A.
  const double low = 2.75 / 5.1688;
  const double high = 3.95 / 5.1688;
  const Simulator averaging(test::edge_scene(0.003), options);
  EXPECT_GT(count_between(averaging.simulate(0).frame.phases[0], low, high), 100);
  const Simulator pinpoint(test::edge_scene(0.003), plain_options());
  EXPECT_EQ(count_between(pinpoint.simulate(0).frame.phases[0], low, high), 0);
}

TEST(Simulator, SameSeedGivesTheSameBitsForAnyNumberOfThreads) {
  SimulatorOptions options;
  options.frames = 2;
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const SimulatedFrame one = Simulator(make_scene("room"), options).simulate(1);
  omp_set_num_threads(4);
  const SimulatedFrame four = Simulator(make_scene("room"), options).simulate(1);
  omp_set_num_threads(threads);
  EXPECT_TRUE(same_values(one.frame.phases[0], four.frame.phases[0]));
  EXPECT_TRUE(same_values(one.frame.phases[1], four.frame.phases[1]));
  EXPECT_TRUE(same_values(one.frame.amplitudes[0], four.frame.amplitudes[0]));
  EXPECT_TRUE(same_values(one.frame.amplitudes[1], four.frame.amplitudes[1]));
  EXPECT_TRUE(same_values(one.range_truth_m, four.range_truth_m));
}

TEST(Simulator, NoiseDiffersBetweenSeedsFramesAndImages) {
  SimulatorOptions options = plain_options();
  options.range_noise_m = 0.02;
  const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
  options.seed = 2;
  const Simulator reseeded(test::facing_wall_scene(3, 0.5), options);
  const auto noise = [](const Simulator& source, int frame) {
    return source.simulate(frame).frame.amplitudes[0];
  };
  EXPECT_FALSE(same_values(noise(simulator, 0), noise(reseeded, 0)));
  EXPECT_FALSE(same_values(noise(simulator, 0), noise(simulator, 1)));
  const Frame frame = simulator.simulate(0).frame;
  EXPECT_FALSE(same_values(frame.amplitudes[0], frame.amplitudes[1]));
}

TEST(Simulator, BIsTakenFromWhereTheCameraIsByThen) {
  SimulatorOptions options = plain_options();
  options.frames = 0;
  options.b_delay_share = 1;  // a whole frame: B sees what the next A does
  const Simulator simulator(test::facing_wall_scene(5, 0.5, 1.0), options);
  ASSERT_GT(*simulator.frame_count(), 10);
  const SimulatedFrame now = simulator.simulate(4);
  const ImageF next_range_m = simulator.simulate(5).range_truth_m;
  const double wavelength_m = simulator.sensor().modulation.wavelength_m(1);
  EXPECT_LT(largest_phase_error(now.frame.phases[1], next_range_m, wavelength_m), 5e-6);
  EXPECT_GT((now.range_truth_m - next_range_m).minCoeff(), 0.03F) << "the camera stood still";
}

TEST(Simulator, WhereNothingIsHitThereIsNoReturn) {
  Scene scene = test::facing_wall_scene(3, 0.5);
  scene.surface = {};
  test::add_facing_wall(scene.surface, 3, 0.5, 0.0);  // the left half of the view
  SimulatorOptions options = plain_options();
  options.range_noise_m = 0.02;
  const SimulatedFrame simulated = Simulator(std::move(scene), options).simulate(0);
  EXPECT_FALSE(simulated.frame.phases[0].leftCols(80).isNaN().any());
  EXPECT_TRUE(simulated.frame.phases[0].rightCols(80).isNaN().all());
  EXPECT_TRUE(simulated.frame.phases[1].rightCols(80).isNaN().all());
  EXPECT_TRUE((simulated.frame.amplitudes[0].rightCols(80) == 0).all());
  EXPECT_TRUE(simulated.range_truth_m.rightCols(80).isNaN().all());
}

TEST(Simulator, SurfacesBeyondTheMaximumRangeReturnNothing) {
  SimulatorOptions options = plain_options();
  options.max_range_m = 4;
  const Simulator simulator(test::facing_wall_scene(5, 0.5), options);
  EXPECT_EQ(simulator.sensor().max_range_m, 4);
  EXPECT_TRUE(simulator.simulate(0).frame.phases[0].isNaN().all());
}

TEST(Simulator, DoesNotTellUnwrappingHowLargeTheSceneIs) {
  const Scene scene = test::facing_wall_scene(5, 0.5);
  ASSERT_GT(scene.max_range_m, 5);
  EXPECT_EQ(Simulator(scene, plain_options()).sensor().max_range_m, 0);
}

TEST(Simulator, TooWeakASignalIsNoReturn) {
  // 6000 × 0.002 / 25 m² is 0.48: it rounds to zero.
  const Simulator simulator(test::facing_wall_scene(5, 0.002), plain_options());
  const SimulatedFrame simulated = simulator.simulate(0);
  EXPECT_TRUE(simulated.frame.phases[0].isNaN().all());
  EXPECT_FALSE(simulated.range_truth_m.isNaN().any());
}

TEST(Simulator, HandsOutItsFramesInOrderAndEnds) {
  Simulator simulator(test::facing_wall_scene(3, 0.5), plain_options());
  for (int i = 0; i < 2; ++i) {
    const auto sourced = simulator.next();
    ASSERT_TRUE(sourced && sourced->frame);
    EXPECT_EQ(sourced->index, i);
    EXPECT_DOUBLE_EQ(sourced->timestamp_s, i / 15.0);
    EXPECT_TRUE(same_values(sourced->frame->phases[0], simulator.simulate(i).frame.phases[0]));
  }
  EXPECT_FALSE(simulator.next());
}

TEST(Simulator, EndsAmidAFrameWhenItIsNotToKeepGoing) {
  std::atomic<int> rows = 0;
  Simulator simulator(test::facing_wall_scene(3, 0.5), plain_options(),
                      [&rows] { return ++rows < 40; });
  EXPECT_FALSE(simulator.next());
  EXPECT_TRUE(simulator.is_stopped());
  const test::TemporaryFolder folder;
  EXPECT_EQ(simulate_sequence(simulator, folder.path() / "out"), 0);
}

TEST(Simulator, FollowsATrajectoryFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "poses.txt";
  Trajectory poses;
  for (int i = 0; i < 3; ++i) {
    poses.push_back({2.5 + i, look_along({0.5 * i, 0, 0}, Eigen::Vector3d::UnitX())});
  }
  write_trajectory(file, poses);
  SimulatorOptions options = plain_options();
  options.frames = 0;
  options.trajectory_file = file.string();
  const Simulator simulator(test::facing_wall_scene(5, 0.5), options);
  ASSERT_EQ(simulator.frame_count(), 3);
  for (int i = 0; i < 3; ++i) {
    const SimulatedFrame simulated = simulator.simulate(i);
    EXPECT_DOUBLE_EQ(simulated.frame.timestamp_s, 2.5 + i);
    EXPECT_NEAR(simulated.range_truth_m(72, 88), 5 - 0.5 * i, 1e-3);
  }
}

TEST(Simulator, NamesATrajectoryFileThatCannotBeUsed) {
  const test::TemporaryFolder folder;
  SimulatorOptions options = plain_options();
  options.trajectory_file = (folder.path() / "none.txt").string();
  EXPECT_THROW(Simulator(test::facing_wall_scene(5, 0.5), options), InputError);
  std::ofstream(options.trajectory_file) << "# no pose\n";
  EXPECT_THROW(Simulator(test::facing_wall_scene(5, 0.5), options), InputError);
}

TEST(Simulator, RefusesOptionsThatAreNotAllowed) {
  const auto refused = [](const char* name, const auto& change) {
    SimulatorOptions options = plain_options();
    change(options);
    try {
      const Simulator simulator(test::facing_wall_scene(3, 0.5), options);
      ADD_FAILURE() << name << " was accepted";
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
  };
  refused("subpixels", [](SimulatorOptions& o) { o.subpixels = 0; });
  refused("b_delay_share", [](SimulatorOptions& o) { o.b_delay_share = 1.5; });
  refused("range_noise_m", [](SimulatorOptions& o) { o.range_noise_m = std::nan(""); });
  refused("max_translation_m", [](SimulatorOptions& o) { o.max_translation_m = 0; });
  refused("width_px", [](SimulatorOptions& o) { o.width_px = -1; });
  refused("offsets_m", [](SimulatorOptions& o) { o.offsets_m = {0.01, 0.02, 0.03, 0.04}; });
  refused("periodic_errors_m", [](SimulatorOptions& o) { o.periodic_errors_m = {0.01}; });
}

TEST(Simulator, RefusesFramesThatItDoesNotHave) {
  const Simulator simulator(test::facing_wall_scene(3, 0.5), plain_options());
  EXPECT_THROW(simulator.simulate(-1), UsageError);
  EXPECT_THROW(simulator.simulate(2), UsageError);
}

}  // namespace
}  // namespace tofmap
