// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// What `joint` promises, on simulated scenes that none of its numbers was fitted to alone. The
// simulated camera does not say how large a scene is: every count that the pair of frequencies can
// tell apart competes, up to 72 m at 29 and 31 MHz.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/common/range_fusion.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

/// Counts right and wrong, of many frames.
struct Tally {
  double all = 0;
  double wrong = 0;
  double sure = 0;  ///< the most confident 90 % of each frame
  double sure_and_wrong = 0;
  std::array<double, 10> in_bin{};
  std::array<double, 10> right_in_bin{};
  std::array<double, 10> confidence_in_bin{};

  double wrong_percent() const { return 100 * wrong / all; }
  double sure_and_wrong_percent() const { return 100 * sure_and_wrong / sure; }

  /// Mean difference between confidence and share of right counts, over bins of confidence.
  double calibration_error_percent() const {
    double sum = 0;
    for (std::size_t b = 0; b < in_bin.size(); ++b) {
      sum += std::abs(confidence_in_bin[b] - right_in_bin[b]);
    }
    return 100 * sum / all;
  }
};

void add_frame(const RangeImage& image, const ImageF& truth_m, double wavelength_m, Tally& tally) {
  struct Pixel {
    float confidence;
    bool is_right;
  };
  std::vector<Pixel> pixels;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    if (image.reason.data()[i] != 0 || std::isnan(truth_m.data()[i])) continue;
    const double error_m = std::abs(image.range_m.data()[i] - truth_m.data()[i]);
    pixels.push_back({image.confidence.data()[i], error_m <= wavelength_m / 2});
  }
  std::ranges::stable_sort(pixels, std::ranges::greater(), &Pixel::confidence);
  const auto sure = static_cast<std::size_t>(0.9 * static_cast<double>(pixels.size()));
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double is_wrong = pixels[i].is_right ? 0 : 1;
    tally.all += 1;
    tally.wrong += is_wrong;
    if (i < sure) {
      tally.sure += 1;
      tally.sure_and_wrong += is_wrong;
    }
    const auto bin = std::min<std::size_t>(static_cast<std::size_t>(10 * pixels[i].confidence), 9);
    tally.in_bin[bin] += 1;
    tally.right_in_bin[bin] += 1 - is_wrong;
    tally.confidence_in_bin[bin] += pixels[i].confidence;
  }
}

/// Frames spread over the path through a scene.
Tally unwrap_frames(const Simulator& simulator, int frames, const UnwrapOptions& options) {
  Tally tally;
  Unwrapper unwrapper(simulator.sensor(), options);
  const int total = *simulator.frame_count();
  for (int i = 0; i < frames; ++i) {
    const SimulatedFrame simulated = simulator.simulate((2 * i + 1) * total / (2 * frames));
    add_frame(unwrapper.unwrap(simulated.frame).image, simulated.range_truth_m,
              simulator.sensor().modulation.wavelength_m(0), tally);
  }
  return tally;
}

Tally unwrap_scene(const std::string& scene, const SimulatorOptions& simulation,
                   const UnwrapOptions& options = {}, int frames = 3) {
  return unwrap_frames(Simulator(make_scene(scene), simulation), frames, options);
}

struct Pair {
  const char* name;
  double frequency_a_hz;
  double frequency_b_hz;
};

class JointAt : public testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Pairs, JointAt,
                         testing::Values(Pair{"29and31MHz", 29e6, 31e6},
                                         Pair{"31and29MHz", 31e6, 29e6},
                                         Pair{"80and100MHz", 80e6, 100e6},
                                         Pair{"37and45MHz", 37.65e6, 45.18e6}),
                         [](const auto& pair) { return std::string(pair.param.name); });

TEST_P(JointAt, UnwrapsAFlat) {
  SimulatorOptions simulation;
  simulation.frequency_a_hz = GetParam().frequency_a_hz;
  simulation.frequency_b_hz = GetParam().frequency_b_hz;
  const Tally joint = unwrap_scene("flat", simulation);
  UnwrapOptions pixel;
  pixel.method = UnwrapMethod::pixel;
  // Mixed pixels, whose truth is that of one of two surfaces, are 0.2 % here.
  EXPECT_LT(joint.wrong_percent(), 0.5);
  EXPECT_LT(joint.wrong_percent(), 0.6 * unwrap_scene("flat", simulation, pixel).wrong_percent());
}

TEST(Joint, UnwrapsACorridorOfSeveralWrapsWhereverItMayEnd) {
  SimulatorOptions simulation;
  const Tally joint = unwrap_scene("corridor", simulation);
  UnwrapOptions jump;
  jump.method = UnwrapMethod::jump;
  EXPECT_LT(joint.wrong_percent(), 0.3);
  EXPECT_LT(joint.wrong_percent(), unwrap_scene("corridor", simulation, jump).wrong_percent());
  EXPECT_LT(joint.sure_and_wrong_percent(), 0.02);
}

TEST(Joint, LeavesPixelsThatSeeTwoSurfacesToTheirNeighbours) {
  UnwrapOptions believing;
  believing.mixed_pixels = false;
  for (const char* scene : {"hall", "flat"}) {
    const Tally leaving = unwrap_scene(scene, {}, {}, 8);
    const Tally all_believed = unwrap_scene(scene, {}, believing, 8);
    // B is not believed at edges as soon as the camera moves, so that little is left to gain.
    EXPECT_LE(leaving.wrong_percent(), all_believed.wrong_percent()) << scene;
    EXPECT_LE(leaving.sure_and_wrong_percent(), all_believed.sure_and_wrong_percent()) << scene;
  }
}

/// Rooms drawn at random, three frames of each.
Tally unwrap_random_rooms(double range_noise_m) {
  Tally tally;
  for (int seed = 1; seed <= 8; ++seed) {
    SimulatorOptions simulation;
    simulation.seed = seed;
    simulation.range_noise_m = range_noise_m;
    const Simulator simulator(make_scene("random", seed), simulation);
    const int total = *simulator.frame_count();
    Unwrapper unwrapper(simulator.sensor(), {});
    for (int i = 0; i < 3; ++i) {
      const SimulatedFrame frame = simulator.simulate((2 * i + 1) * total / 6);
      add_frame(unwrapper.unwrap(frame.frame).image, frame.range_truth_m,
                simulator.sensor().modulation.wavelength_m(0), tally);
    }
  }
  return tally;
}

class JointInRandomRooms : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Noise, JointInRandomRooms, testing::Values(0.02, 0.05));

TEST_P(JointInRandomRooms, KnowsHowSureItIs) {
  const Tally tally = unwrap_random_rooms(GetParam());
  EXPECT_LT(tally.wrong_percent(), GetParam() < 0.03 ? 2 : 5);
  EXPECT_LT(tally.sure_and_wrong_percent(), 0.35 * tally.wrong_percent());
  EXPECT_LT(tally.calibration_error_percent(), 2);
}

TEST(Joint, UnwrapsWhereOnlyNeighbourhoodsCarryInformation) {
  SimulatorOptions simulation;
  simulation.range_noise_m = 0.8;  // about one radian a pixel
  const double percent = unwrap_scene("flat", simulation).wrong_percent();
  UnwrapOptions pixels_alone;
  pixels_alone.scales = 1;
  UnwrapOptions jump;
  jump.method = UnwrapMethod::jump;
  EXPECT_LT(percent, 3);
  EXPECT_LT(percent, 0.7 * unwrap_scene("flat", simulation, pixels_alone).wrong_percent());
  EXPECT_LT(percent, 0.5 * unwrap_scene("flat", simulation, jump).wrong_percent());
}

TEST(Joint, NeedsNoAmplitudes) {
  const Simulator simulator(make_scene("room"), {});
  SimulatedFrame simulated = simulator.simulate(40);
  simulated.frame.amplitudes[0].resize(0, 0);
  simulated.frame.amplitudes[1].resize(0, 0);
  Tally tally;
  add_frame(unwrap(simulated.frame, simulator.sensor(), {}).image, simulated.range_truth_m,
            simulator.sensor().modulation.wavelength_m(0), tally);
  EXPECT_LT(tally.wrong_percent(), 2);
}

TEST(Joint, ReportsCountsThatThePairCannotTellApart) {
  // 80 and 100 MHz repeat after 7.5 m; if the room may be 14 m long, most pixels have two ranges.
  SimulatorOptions simulation;
  simulation.frequency_a_hz = 80e6;
  simulation.frequency_b_hz = 100e6;
  const Simulator simulator(make_scene("flat"), simulation);
  const SimulatedFrame simulated = simulator.simulate(20);
  UnwrapOptions options;
  options.max_range_m = 14;
  const RangeImage image = unwrap(simulated.frame, simulator.sensor(), options).image;
  EXPECT_GT(count_reason(image, InvalidReason::ambiguous),
            0.9 * static_cast<double>(image.reason.size()));
  options.max_range_m = 400;  // each range fifty times
  const RangeImage far = unwrap(simulated.frame, simulator.sensor(), options).image;
  EXPECT_GT(count_reason(far, InvalidReason::ambiguous),
            0.9 * static_cast<double>(far.reason.size()));
  options.max_range_m = 7.4;
  const RangeImage certain = unwrap(simulated.frame, simulator.sensor(), options).image;
  EXPECT_EQ(count_reason(certain, InvalidReason::ambiguous), 0);
}

TEST(Joint, GivesTheSameBitsWhateverItsBuffersHeldBefore) {
  const Simulator simulator(make_scene("corridor"), {});
  const SimulatedFrame first = simulator.simulate(10);
  const SimulatedFrame second = simulator.simulate(60);
  FrameMeasurer measurer(simulator.sensor(), {});
  Unwrapper unwrapper(simulator.sensor(), {});
  unwrapper.unwrap(measurer.measure(first.frame));
  const MeasuredFrame measured = measurer.measure(second.frame);
  const RangeImage used = unwrapper.unwrap(measured).image;
  const RangeImage fresh = Unwrapper(simulator.sensor(), {}).unwrap(measured).image;
  EXPECT_TRUE((used.wrap_count == fresh.wrap_count).all());
  EXPECT_TRUE((used.confidence == fresh.confidence).all());
  EXPECT_TRUE((used.range_m == fresh.range_m || used.range_m.isNaN()).all());
}

/// Root mean square error of the ranges with right counts, and the predicted one.
struct RangeErrors {
  double measured_m = 0;
  double predicted_m = 0;
};

RangeErrors range_errors(bool fuse) {
  SimulatorOptions simulation;
  simulation.subpixels = 1;
  simulation.b_delay_share = 0;
  const Simulator simulator(make_scene("wall"), simulation);
  const SimulatedFrame simulated = simulator.simulate(5);
  UnwrapOptions options;
  options.fuse_frequencies = fuse;
  const RangeImage image = unwrap(simulated.frame, simulator.sensor(), options).image;
  const ImageF error = image.range_m - simulated.range_truth_m;
  double squares = 0;
  double variances = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < error.size(); ++i) {
    if (image.reason.data()[i] != 0 || std::abs(error.data()[i]) > 1) continue;
    squares += error.data()[i] * error.data()[i];
    variances += image.sigma_m.data()[i] * image.sigma_m.data()[i];
    ++count;
  }
  return {std::sqrt(squares / count), std::sqrt(variances / count)};
}

TEST(Fusion, HasLessNoiseThanEitherFrequencyAndPredictsIt) {
  const RangeErrors alone = range_errors(false);
  const RangeErrors fused = range_errors(true);
  // A and B have nearly the same noise: half the variance, from 25 000 pixels.
  EXPECT_NEAR(fused.measured_m / alone.measured_m, 1 / std::sqrt(2.0), 0.04);
  EXPECT_NEAR(fused.measured_m / fused.predicted_m, 1, 0.06);
}

/// Mean errors of the ranges with right counts, of frames one after the other, where B was taken a
/// whole frame after A. The first frames are looked ahead at, as the program does.
std::vector<double> mean_errors_m(const UnwrapOptions& options) {
  SimulatorOptions simulation;
  simulation.subpixels = 1;
  simulation.b_delay_share = 1;
  simulation.max_translation_m = 0.07;
  const Simulator simulator(make_scene("corridor"), simulation);
  std::vector<SimulatedFrame> run;
  std::vector<Frame> ahead;
  for (int i = 0; i < FrameMeasurer::frames_ahead; ++i) {
    run.push_back(simulator.simulate(40 + i));
    ahead.push_back(run.back().frame);
  }
  FrameMeasurer measurer(simulator.sensor(), options);
  measurer.look_ahead(ahead);
  Unwrapper unwrapper(simulator.sensor(), options);
  std::vector<double> means_m;
  for (const SimulatedFrame& simulated : run) {
    const RangeImage image = unwrapper.unwrap(measurer.measure(simulated.frame)).image;
    const ImageF error = image.range_m - simulated.range_truth_m;
    double sum = 0;
    int count = 0;
    for (Eigen::Index i = 0; i < error.size(); ++i) {
      if (image.reason.data()[i] != 0 || !(std::abs(error.data()[i]) < 0.3)) continue;
      sum += error.data()[i];
      ++count;
    }
    means_m.push_back(sum / count);
  }
  return means_m;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

TEST(Fusion, AllowsForTheMotionBetweenTheExposures) {
  UnwrapOptions as_it_comes;
  as_it_comes.systematic_errors = false;
  // The camera walks down the corridor at 7 cm a frame. Most of what it sees are walls along its
  // way, which stay as far; the rest comes nearer.
  EXPECT_LT(mean(mean_errors_m(as_it_comes)), -0.002);
  // On one frame motion along the view and an offset between the frequencies differ only by where
  // walls lie along the way. Of 6 cm the tracker takes 3 mm for an offset, frame after frame since
  // all move alike, and B, which is off by that, has half of the weight.
  for (const double mean_m : mean_errors_m({})) EXPECT_NEAR(mean_m, 0, 0.002);
}

TEST(Fusion, LeavesAPixelAloneWhoseFrequenciesDisagree) {
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  const UnwrapLimits limits = unwrap_limits(sensor, 20);
  Frame frame = blank_frame(2);
  frame.phases[0] = ImageF::Constant(1, 1, 0.5F);
  frame.phases[1] = ImageF::Constant(1, 1, 0.9F);
  frame.amplitudes[0] = frame.amplitudes[1] = ImageF::Constant(1, 1, 1.0F);
  const FusedRanges out = fuse_ranges(frame, ImageU8::Constant(1, 1, 1), limits,
                                      PhaseSigma(frame, {{0.01}, {0.01}}), {0, 0});
  EXPECT_FLOAT_EQ(out.range_m(0, 0), static_cast<float>(1.5 * limits.wavelength_m()));
  EXPECT_FLOAT_EQ(out.sigma_m(0, 0), static_cast<float>(0.01 * limits.wavelength_m()));
}

TEST(Halving, AveragesPhasorsAndTheirNoise) {
  Frame frame = blank_frame(2);
  frame.phases[0].resize(3, 2);
  frame.phases[0] << 0.95F, 0.05F, 0.95F, 0.05F, 0.25F, NAN;
  frame.phases[1] = frame.phases[0];
  frame.amplitudes[0] = frame.amplitudes[1] = ImageF::Constant(3, 2, 10.0F);
  const auto [half, sigma] = halve(frame, PhaseSigma(frame, {{.scale = 0.4}, {.scale = 0.4}}));
  ASSERT_EQ(half.phases[0].rows(), 2);
  ASSERT_EQ(half.phases[0].cols(), 1);
  const float from_zero = half.phases[0](0, 0) - std::round(half.phases[0](0, 0));
  EXPECT_NEAR(from_zero, 0, 1e-6) << "the mean of phases on both sides of 0";
  const double agreement = std::cos(0.1 * 3.14159265);
  EXPECT_NEAR(half.amplitudes[0](0, 0), 10 * agreement, 1e-4);
  EXPECT_NEAR(sigma.cycles[0](0, 0), 0.04 / 2 / agreement, 1e-6) << "of four pixels";
  EXPECT_NEAR(half.phases[0](1, 0), 0.25, 1e-6);
  EXPECT_NEAR(half.amplitudes[0](1, 0), 10, 1e-4);
  EXPECT_NEAR(sigma.cycles[0](1, 0), 0.04, 1e-6) << "one pixel alone is no less noisy in a block";
}

}  // namespace
}  // namespace tofmap
