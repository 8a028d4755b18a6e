// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// Cameras with one frequency and with more than two.

#include "common/frequency_order.hpp"
#include "common/pixel_counts.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/frequency_residual.hpp>
#include <tofmap/simulation/simulator.hpp>
#include <tofmap/unwrap/common/range_fusion.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>
#include <tofmap/unwrap/unwrap.hpp>

namespace tofmap {
namespace {

SensorModel sensor_with(std::vector<double> frequencies_hz) {
  SensorModel sensor;
  sensor.modulation.frequencies_hz = std::move(frequencies_hz);
  return sensor;
}

SimulatorOptions small_camera(std::vector<double> frequencies_hz) {
  SimulatorOptions options;
  options.width_px = 88;
  options.height_px = 72;
  options.frequencies_hz = std::move(frequencies_hz);
  options.subpixels = 1;  // no mixed pixels, which have no right count
  return options;
}

/// Percentage of the pixels with a range that are off by more than half a wavelength of the first
/// frequency.
double wrong_percent(const RangeImage& image, const ImageF& truth_m, double wavelength_m) {
  double all = 0;
  double wrong = 0;
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    if (image.reason.data()[i] != 0 || std::isnan(truth_m.data()[i])) continue;
    ++all;
    if (std::abs(image.range_m.data()[i] - truth_m.data()[i]) > wavelength_m / 2) ++wrong;
  }
  EXPECT_GT(all, 0.5 * static_cast<double>(truth_m.size()));
  return 100 * wrong / all;
}

TEST(UnwrapLimits, OfThreeFrequenciesReachUpToTheCombinedRange) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 0);
  EXPECT_NEAR(limits.max_range_m, speed_of_light_m_per_s / 2 / 8e6, 1e-6);
  EXPECT_EQ(limits.count, 10);
  EXPECT_TRUE(are_absolute(limits));
  EXPECT_FALSE(can_tell_apart(limits, 0, 10)) << "18.7 m farther";
  EXPECT_TRUE(can_tell_apart(limits, 0, 5)) << "120 MHz tells, 16 MHz does not";
  EXPECT_TRUE(can_tell_apart(limits, 0, 2)) << "16 MHz tells, 120 MHz does not";
}

TEST(UnwrapLimits, OfOneFrequencyAreNotAbsolute) {
  EXPECT_FALSE(are_absolute(unwrap_limits(sensor_with({30e6}), 0)));
  EXPECT_TRUE(are_absolute(unwrap_limits(sensor_with({30e6}), 4.9)));
}

TEST(UnwrapLimits, OfAPairOfFrequenciesCountTheFirstOfThePair) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 12);
  const PairLimits pair = limits.pair(2, 1);
  EXPECT_DOUBLE_EQ(pair.wavelength_a_m, speed_of_light_m_per_s / 240e6);
  EXPECT_DOUBLE_EQ(pair.wavelength_b_m, speed_of_light_m_per_s / 32e6);
  EXPECT_EQ(pair.count_a, 10);
}

class EveryOrder : public testing::TestWithParam<std::vector<double>> {};

TEST_P(EveryOrder, OfThreeFrequenciesUnwrapsALitRoom) {
  SimulatorOptions lit = small_camera(GetParam());
  // The same phase noise, whichever frequency is the first.
  lit.range_noise_m = 0.01 * 80e6 / GetParam().front();
  // Motion and systematic errors are estimated relative to the first frequency. Ranges at 16 MHz
  // are five times as noisy, so what they tell of the others spoils some pixels.
  const double most_wrong_percent = GetParam().front() == 16e6 ? 2.5 : 0.5;
  const Simulator simulator(make_scene("room"), lit);
  Unwrapper unwrapper(simulator.sensor(), {});
  for (const int index : {0, 40}) {
    const SimulatedFrame simulated = simulator.simulate(index);
    const UnwrapResult result = unwrapper.unwrap(simulated.frame);
    EXPECT_LT(wrong_percent(result.image, simulated.range_truth_m, 1.8737), most_wrong_percent);
    ASSERT_EQ(result.errors.size(), 3U);
  }
}

INSTANTIATE_TEST_SUITE_P(Frequencies, EveryOrder,
                         testing::Values(std::vector<double>{80e6, 16e6, 120e6},
                                         std::vector<double>{80e6, 120e6, 16e6},
                                         std::vector<double>{120e6, 80e6, 16e6},
                                         std::vector<double>{120e6, 16e6, 80e6},
                                         std::vector<double>{16e6, 80e6, 120e6},
                                         std::vector<double>{16e6, 120e6, 80e6}));

TEST(ManyFrequencies, GiveTheSameRangesInEveryOrder) {
  SimulatorOptions options = small_camera({80e6, 16e6, 120e6});
  options.range_noise_m = 0.05;
  const Simulator simulator(make_scene("random"), options);
  const SimulatedFrame simulated = simulator.simulate(0);
  UnwrapOptions by_noise_alone;
  by_noise_alone.systematic_errors = false;  // they are those of the first frequency to the others
  for (const bool fuses : {true, false}) {
    by_noise_alone.fuse_frequencies = fuses;
    const RangeImage wanted = unwrap(simulated.frame, simulator.sensor(), by_noise_alone).image;
    std::vector<std::size_t> order = {0, 1, 2};
    while (std::ranges::next_permutation(order).found) {
      const SensorModel sensor = with_frequencies(simulator.sensor(), order);
      const Frame frame = with_frequencies(simulated.frame, order);
      const RangeImage found = unwrap(frame, sensor, by_noise_alone).image;
      for (Eigen::Index i = 0; i < found.range_m.size(); ++i) {
        ASSERT_EQ(found.reason.data()[i], wanted.reason.data()[i]);
        if (found.reason.data()[i] != 0) continue;
        const double range_m = found.range_m.data()[i];
        const double cycles = range_m / sensor.modulation.wavelength_m(0);
        const int count = found.wrap_count.data()[i];
        if (fuses) {
          ASSERT_EQ(found.range_m.data()[i], wanted.range_m.data()[i]);
          ASSERT_EQ(found.sigma_m.data()[i], wanted.sigma_m.data()[i]);
          // Counts that follow from ranges are those nearest to them, but not negative.
          const double off = std::abs(cycles - count - frame.phases[0].data()[i]);
          ASSERT_TRUE(order.front() == 0 || count == 0 || off <= 0.5) << off;
        } else {
          ASSERT_NEAR(cycles, count + frame.phases[0].data()[i], 1e-5);
        }
        ASSERT_EQ(found.confidence.data()[i], wanted.confidence.data()[i]);
      }
    }
  }
}

TEST(CountingOrder, TakesTheFirstOfTwoAndTheLongestShortWavelengthOfMore) {
  const auto counted_hz = [](const std::vector<double>& frequencies_hz, double max_range_m) {
    const UnwrapLimits limits = unwrap_limits(sensor_with(frequencies_hz), max_range_m);
    return frequencies_hz[counting_order(limits).front()];
  };
  EXPECT_EQ(counted_hz({29e6, 31e6}, 0), 29e6);
  EXPECT_EQ(counted_hz({31e6, 29e6}, 0), 31e6);
  EXPECT_EQ(counted_hz({80e6, 100e6}, 0), 80e6);
  EXPECT_EQ(counted_hz({16e6, 80e6}, 0), 80e6) << "a fifth of the wavelength";
  EXPECT_EQ(counted_hz({80e6, 16e6}, 0), 80e6);
  EXPECT_EQ(counted_hz({16e6, 120e6, 80e6}, 0), 80e6) << "of 1.9 m, 120 MHz of 1.2 m";
  EXPECT_EQ(counted_hz({16e6, 80e6}, 1000), 16e6) << "534 wrap counts of 80 MHz";
  EXPECT_EQ(counted_hz({30e6}, 0), 30e6);
}

TEST(CountingOrder, KeepsTheOtherFrequenciesAsTheyWere) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({16e6, 120e6, 80e6}), 12);
  const std::vector<std::size_t> order = counting_order(limits);
  EXPECT_THAT(order, testing::ElementsAre(2, 0, 1));
  const UnwrapLimits counted = in_order(limits, order);
  EXPECT_EQ(counted.count, 7);
  EXPECT_DOUBLE_EQ(counted.wavelengths_m[1], limits.wavelengths_m[0]);
}

TEST(ManyFrequencies, AreBetterThanTwoOfThem) {
  SimulatorOptions options = small_camera({80e6, 16e6, 120e6});
  options.range_noise_m = 0.04;
  const Simulator simulator(make_scene("hall"), options);
  const SimulatedFrame simulated = simulator.simulate(0);
  UnwrapOptions up_to_18_m;
  up_to_18_m.max_range_m = 18.7;
  const auto wrong = [&](const Frame& frame, const SensorModel& sensor) {
    return wrong_percent(unwrap(frame, sensor, up_to_18_m).image, simulated.range_truth_m, 1.8737);
  };
  const double of_three = wrong(simulated.frame, simulator.sensor());
  // 80 and 16 MHz alone are ambiguous beyond 9 m, 80 and 120 MHz beyond 4 m.
  const double of_two = wrong(with_frequencies(simulated.frame, {2, 1}),
                              with_frequencies(simulator.sensor(), {2, 1}));
  EXPECT_LT(of_three, of_two);
}

TEST(ManyFrequencies, ShareTheMotionOfTheirExposures) {
  // Multipath light bends the residuals of 16 MHz most, which by themselves look like motion.
  SimulatorOptions options = small_camera({80e6, 16e6, 120e6});
  options.multipath_rays = 8;
  options.offsets_m = {0.02, -0.03, 0.01};
  const Simulator simulator(make_scene("corridor"), options);
  Unwrapper unwrapper(simulator.sensor(), {});
  for (int index = 0; index < 3; ++index) {
    const UnwrapResult result = unwrapper.unwrap(simulator.simulate(index).frame);
    const ExposureMotion& of_second = result.errors[1].motion;
    const ExposureMotion& of_third = result.errors[2].motion;
    ASSERT_GE(result.errors[2].support, 0.8);
    // Exposures follow each other at equal distances. Three standard deviations of what remains.
    EXPECT_LT((of_second.translation_m - 0.5 * of_third.translation_m).norm(), 3 * 0.002);
    EXPECT_LT((of_second.rotation_rad - 0.5 * of_third.rotation_rad).norm(), 3 * 0.001);
  }
}

TEST(OneFrequency, GivesCountsRelativeToTheNearestPixelOfEachRegion) {
  // A wall from 6 to 9 m, which the wavelength of 5 m wraps once within the image.
  const SensorModel sensor = sensor_with({30e6});
  const double wavelength_m = sensor.modulation.wavelength_m(0);
  Frame frame = blank_frame(1);
  ImageF truth_m(20, 60);
  for (Eigen::Index u = 0; u < truth_m.cols(); ++u)
    truth_m.col(u) = 6 + 0.07F * static_cast<float>(u);
  frame.phases[0] = truth_m.unaryExpr([&](float range_m) {
    const double cycles = range_m / wavelength_m;
    return static_cast<float>(cycles - std::floor(cycles));
  });
  const UnwrapResult result = unwrap(frame, sensor, {});
  EXPECT_EQ(result.image.count_valid(), truth_m.size());
  EXPECT_EQ(result.image.wrap_count.minCoeff(), 0);
  EXPECT_LT(((result.image.range_m + static_cast<float>(wavelength_m)) - truth_m).abs().maxCoeff(),
            1e-4F);
  EXPECT_LE(result.image.confidence.maxCoeff(), 1.0F / 255) << "any absolute count is possible";
}

TEST(OneFrequency, IsSureWhereNoRangeExceedsItsWavelength) {
  const SensorModel sensor = sensor_with({30e6});
  Frame frame = blank_frame(1);
  frame.phases[0] = ImageF::Constant(20, 30, 0.5F);
  UnwrapOptions options;
  options.max_range_m = 4.9;
  const UnwrapResult result = unwrap(frame, sensor, options);
  EXPECT_GT(result.image.confidence.minCoeff(), 0.5F);
}

TEST(OneFrequency, TellsJumpsNoMoreThanJointDoes) {
  const SensorModel sensor = sensor_with({30e6});
  Frame frame = blank_frame(1);
  frame.phases[0] = ImageF::Constant(20, 30, 0.5F);
  UnwrapOptions single;
  single.method = UnwrapMethod::single;
  EXPECT_LE(unwrap(frame, sensor, single).image.confidence.maxCoeff(), 1.0F / 255);
}

TEST(OneFrequency, IsTooFewForMethodsThatCompareTwo) {
  for (const UnwrapMethod method : {UnwrapMethod::jump, UnwrapMethod::paper}) {
    UnwrapOptions options;
    options.method = method;
    EXPECT_THROW(Unwrapper(sensor_with({30e6}), options), UsageError);
  }
}

TEST(ComparedPair, IsUnambiguousUpToTheLongestRange) {
  const auto pair_of = [](const std::vector<double>& frequencies_hz, int first, int second) {
    UnwrapOptions options;
    options.method = UnwrapMethod::jump;
    options.pair_first = first;
    options.pair_second = second;
    const ComparedPair pair = compared_pair(options, sensor_with(frequencies_hz).modulation);
    return std::pair(pair.a, pair.b.value());
  };
  using Pair = std::pair<std::size_t, std::size_t>;
  const std::vector<double> kinect_hz{80e6, 16e6, 120e6};
  EXPECT_EQ(pair_of(kinect_hz, 0, 0), Pair(2, 1)) << "18.7 m; 80 and 16 MHz: 9.4 m";
  EXPECT_EQ(pair_of(kinect_hz, 2, 0), Pair(1, 2));
  EXPECT_EQ(pair_of(kinect_hz, 0, 1), Pair(1, 0)) << "80 and 120 MHz: 3.7 m";
  EXPECT_EQ(pair_of(kinect_hz, 1, 3), Pair(0, 2));
  EXPECT_EQ(pair_of({29e6, 31e6}, 0, 0), Pair(0, 1));
  EXPECT_EQ(pair_of({31e6, 29e6}, 0, 0), Pair(0, 1));
}

TEST(ComparedPair, HasNoWrapCountsThatItCannotTellApart) {
  const SensorModel sensor = sensor_with({80e6, 16e6, 120e6});
  const UnwrapLimits limits = unwrap_limits(sensor, 0);
  EXPECT_NEAR(limits.max_range_m, 18.74, 0.01);
  EXPECT_NEAR(pair_limits({0, 1}, sensor.modulation, limits).max_range_m, 9.37, 0.01);
  EXPECT_EQ(pair_limits({0, 1}, sensor.modulation, limits).count_a, 5);
  EXPECT_NEAR(pair_limits({2, 1}, sensor.modulation, limits).max_range_m, 18.74, 0.01);
  UnwrapOptions options;
  options.method = UnwrapMethod::jump;
  EXPECT_FALSE(pair_warning(options, sensor));
  options.pair_first = 1;
  options.pair_second = 2;
  EXPECT_THAT(pair_warning(options, sensor).value_or(""),
              testing::HasSubstr("jump compares 80 and 16 MHz"));
  options.method = UnwrapMethod::joint;
  EXPECT_FALSE(pair_warning(options, sensor));
}

TEST(ComparedPair, IsTheOneThatTheOptionsName) {
  SimulatorOptions camera = small_camera({80e6, 29e6, 31e6});
  camera.b_delay_share = 0;
  camera.range_noise_m = 0.004;
  const Simulator simulator(make_scene("room"), camera);
  const SimulatedFrame simulated = simulator.simulate(0);
  UnwrapOptions options;
  options.method = UnwrapMethod::jump;
  options.pair_first = 2;
  options.pair_second = 3;
  const RangeImage of_three = unwrap(simulated.frame, simulator.sensor(), options).image;
  EXPECT_LT(wrong_percent(of_three, simulated.range_truth_m, 5.17), 1);
  // The wrap counts are those of the first frequency of the recording.
  const double first_m = simulator.sensor().modulation.wavelength_m(0);
  for (Eigen::Index i = 0; i < of_three.range_m.size(); ++i) {
    if (of_three.reason.data()[i] != 0) continue;
    const double cycles =
        of_three.range_m.data()[i] / first_m - simulated.frame.phases[0].data()[i];
    ASSERT_EQ(of_three.wrap_count.data()[i], std::max(0L, std::lround(cycles)));
  }
  options.pair_second = 4;
  EXPECT_THROW(Unwrapper(simulator.sensor(), options), UsageError);
  options.pair_second = 2;
  EXPECT_THROW(Unwrapper(simulator.sensor(), options), UsageError) << "compared with itself";
}

/// Random phases and noise of three frequencies.
struct RandomPixels {
  Frame frame;
  PhaseSigma sigma;

  explicit RandomPixels(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> phases(0, 1);
    std::uniform_real_distribution<float> sigmas(0.01F, 0.1F);
    for (int f = 0; f < 3; ++f) {
      frame.phases.push_back(ImageF::NullaryExpr(12, 17, [&] { return phases(random); }));
      sigma.cycles.push_back(ImageF::NullaryExpr(12, 17, [&] { return sigmas(random); }));
    }
  }
};

/// The cost of a wrap count in double precision: half of the squared differences of all ranges from
/// their weighted mean, in variances.
double plain_cost(const RandomPixels& pixels, const UnwrapLimits& limits, Eigen::Index i,
                  int count) {
  double range_m = 0;
  double variance_m2 = 0;
  double cost = 0;
  for (const std::size_t f : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
    const double wavelength_m = limits.wavelengths_m[f];
    const double sigma_m = wavelength_m * pixels.sigma.cycles[f].data()[i];
    const double phase = pixels.frame.phases[f].data()[i];
    if (f == 0) {
      range_m = (phase + count) * wavelength_m;
      variance_m2 = sigma_m * sigma_m;
      continue;
    }
    const double residual_m = std::remainder(range_m - phase * wavelength_m, wavelength_m);
    const double sum_m2 = variance_m2 + sigma_m * sigma_m;
    cost += residual_m * residual_m / sum_m2 / 2;
    range_m -= residual_m * variance_m2 / sum_m2;
    variance_m2 *= sigma_m * sigma_m / sum_m2;
  }
  return cost;
}

TEST(PixelCounts, OfThreeFrequenciesHaveTheLeastCost) {
  const RandomPixels pixels(3);
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 0);
  const ImageU8 counts = nearest_counts(pixels.frame, limits, pixels.sigma);
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    const double found = plain_cost(pixels, limits, i, counts.data()[i]);
    for (int n = 0; n < limits.count; ++n) {
      const double range_m = (pixels.frame.phases[0].data()[i] + n) * limits.wavelength_m();
      if (range_m > limits.max_range_m) continue;
      ASSERT_LE(found, plain_cost(pixels, limits, i, n) * (1 + 1e-3) + 1e-3) << i << ' ' << n;
    }
  }
}

TEST(RangeFusion, OfThreeFrequenciesIsTheMeanByInverseVariances) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 0);
  constexpr double range_m = 4.2;
  const std::vector<double> errors_m{0.004, -0.02, 0.001};
  const std::vector<double> sigmas_cycles{0.005, 0.004, 0.006};
  Frame frame = blank_frame(3);
  PhaseSigma sigma;
  double sum = 0;
  double weights = 0;
  for (std::size_t f = 0; f < 3; ++f) {
    const double wavelength_m = limits.wavelengths_m[f];
    const double cycles = (range_m + errors_m[f]) / wavelength_m;
    frame.phases[f] = ImageF::Constant(1, 1, static_cast<float>(cycles - std::floor(cycles)));
    sigma.cycles.push_back(ImageF::Constant(1, 1, static_cast<float>(sigmas_cycles[f])));
    const double weight = std::pow(sigmas_cycles[f] * wavelength_m, -2);
    sum += weight * (range_m + errors_m[f]);
    weights += weight;
  }
  const FusedRanges fused =
      fuse_ranges(frame, ImageU8::Constant(1, 1, 2), limits, sigma, {0, 0.01, 0.01});
  EXPECT_NEAR(fused.range_m(0, 0), sum / weights, 1e-5);
  EXPECT_NEAR(fused.sigma_m(0, 0), 1 / std::sqrt(weights), 1e-6);
}

TEST(RangeFusion, LeavesOutTheFrequencyThatDisagrees) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 0);
  Frame frame = blank_frame(3);
  PhaseSigma sigma;
  for (std::size_t f = 0; f < 3; ++f) {
    const double cycles = (f == 2 ? 4.5 : 4.2) / limits.wavelengths_m[f];
    frame.phases[f] = ImageF::Constant(1, 1, static_cast<float>(cycles - std::floor(cycles)));
    sigma.cycles.push_back(ImageF::Constant(1, 1, 0.002F));
  }
  const FusedRanges fused =
      fuse_ranges(frame, ImageU8::Constant(1, 1, 2), limits, sigma, {0, 0, 0});
  EXPECT_NEAR(fused.range_m(0, 0), 4.2, 1e-4);
}

TEST(WrapCountModel, MultipliesTheLikelihoodsOfAllFrequencies) {
  const UnwrapLimits limits = unwrap_limits(sensor_with({80e6, 16e6, 120e6}), 0);
  const RandomPixels pixels(5);
  WrapCountModel model;
  WrapCountPrior prior;
  prior.mixed_pixels = false;
  model.assign(pixels.frame, limits, pixels.sigma, {0, 0, 0}, prior);
  for (int v = 0; v < 12; ++v) {
    for (int u = 0; u < 17; ++u) {
      // Equation 11 in double precision, one frequency after the other.
      std::vector<double> expected;
      for (int n = 0; n < limits.count; ++n) {
        double range_m = (pixels.frame.phases[0](v, u) + n) * limits.wavelength_m();
        double variance_m2 = std::pow(pixels.sigma.cycles[0](v, u) * limits.wavelength_m(), 2);
        double likelihood = range_m <= limits.max_range_m + 0.05 * limits.wavelength_m() ? 1 : 0;
        for (const std::size_t f : {std::size_t{1}, std::size_t{2}}) {
          const double wavelength_m = limits.wavelengths_m[f];
          const double own_m2 = std::pow(pixels.sigma.cycles[f](v, u) * wavelength_m, 2);
          const double sigma_cycles = std::sqrt(variance_m2 + own_m2) / wavelength_m;
          const double offset =
              std::remainder(range_m / wavelength_m - pixels.frame.phases[f](v, u), 1);
          const double density =
              (std::exp(-0.5 * std::pow(offset / sigma_cycles, 2)) +
               std::exp(-0.5 * std::pow((1 - std::abs(offset)) / sigma_cycles, 2))) /
              (sigma_cycles * std::sqrt(2 * std::acos(-1.0)));
          const double of_surface = (1 - prior.outlier_share) * density;
          likelihood *= prior.outlier_share + of_surface;
          const double trust = of_surface / (prior.outlier_share + of_surface);
          const double gain = trust * variance_m2 / (variance_m2 + own_m2);
          range_m -= gain * offset * wavelength_m;
          variance_m2 *= 1 - gain;
        }
        expected.push_back(likelihood);
      }
      const double best = *std::ranges::max_element(expected);
      const std::vector<double> found = model.evidence_of(v, u);
      for (std::size_t n = 0; n < expected.size(); ++n) {
        // Tempered by the power 4, and stored with 8 binary digits before and after it.
        const double wanted = std::max(std::pow(expected[n] / best, 4), 1e-8);
        ASSERT_NEAR(found[n] / wanted, 1, 0.05) << v << ' ' << u << ' ' << n;
      }
    }
  }
}

TEST(FrameMeasurer, RefusesAFrameOfOtherFrequencies) {
  FrameMeasurer measurer(sensor_with({80e6, 16e6, 120e6}), {});
  Frame frame = blank_frame(2);
  frame.phases.assign(2, ImageF::Constant(4, 4, 0.5F));
  EXPECT_THROW(measurer.measure(frame), UsageError);
}

}  // namespace
}  // namespace tofmap
