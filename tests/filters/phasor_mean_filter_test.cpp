// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>
#include <tofmap/filters/phasor_mean_filter.hpp>

namespace tofmap {
namespace {

const CameraModel& wide_camera() {
  static const CameraModel camera = pinhole_camera(1, 64, 48);
  return camera;
}

/// Their wraps repeat together after 19.9 m.
Modulation far_apart() { return {37.65e6, 45.18e6}; }

/// Those of a Kinect v2.
Modulation three() { return {80e6, 16e6, 120e6}; }

float wavelength_a_m() { return static_cast<float>(far_apart().wavelength_m(0)); }

/// A wall seen aslant, its ranges from 3.4 to 7.5 m.
ImageF slanted_wall() {
  const PixelRays rays = pixel_rays(wide_camera());
  return 4.5F / (rays.z + 0.6F * rays.x);
}

/// A wall at 3 m before another one 1.2 m behind it.
ImageF two_walls() {
  const PixelRays rays = pixel_rays(wide_camera());
  ImageF range_m = 3 / rays.z;
  range_m.rightCols(32) *= 1.4F;
  return range_m;
}

/// A frame, and what unwrapping made of it.
struct Recorded {
  Frame frame;
  RangeImage image;
};

float wrapped(float cycles) { return cycles - std::floor(cycles); }

/// Phases with normal noise of this size, and counts of A of which one in twenty is another one.
Recorded recorded(const ImageF& truth_m, const ImageF& sigma_rad, unsigned seed,
                  const Modulation& modulation = far_apart()) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  const auto wavelength_m = static_cast<float>(modulation.wavelength_m(0));
  const int last_count = static_cast<int>(truth_m.maxCoeff() / wavelength_m) + 3;
  std::uniform_int_distribution<int> one_of_twenty(0, 19);
  std::uniform_int_distribution<int> any_count(0, last_count);
  Recorded out{blank_frame(modulation.count()), RangeImage(truth_m.rows(), truth_m.cols())};
  out.frame.phases.assign(modulation.count(), truth_m);
  out.image.reason.setZero();
  out.image.confidence.setConstant(0.95F);
  for (Eigen::Index i = 0; i < truth_m.size(); ++i) {
    const float sigma_cycles = sigma_rad.data()[i] / (2 * std::numbers::pi_v<float>);
    const float range_m = truth_m.data()[i];
    for (std::size_t f = 0; f < modulation.count(); ++f) {
      const float cycles = range_m / static_cast<float>(modulation.wavelength_m(f));
      out.frame.phases[f].data()[i] = wrapped(cycles + sigma_cycles * normal(random));
    }
    const float a = out.frame.phases[0].data()[i];
    const float right_count = std::max(0.0F, std::round(range_m / wavelength_m - a));
    const int count =
        one_of_twenty(random) == 0 ? any_count(random) : static_cast<int>(right_count);
    out.image.wrap_count.data()[i] = static_cast<std::uint8_t>(count);
    out.image.range_m.data()[i] = (a + static_cast<float>(count)) * wavelength_m;
    out.image.sigma_m.data()[i] = sigma_cycles * wavelength_m;
  }
  return out;
}

Recorded recorded(const ImageF& truth_m, float sigma_rad, unsigned seed,
                  const Modulation& modulation = far_apart()) {
  return recorded(truth_m, ImageF::Constant(truth_m.rows(), truth_m.cols(), sigma_rad), seed,
                  modulation);
}

RangeImage averaged(const Recorded& recorded, const PhasorMeanLimits& limits = {},
                    const Modulation& modulation = far_apart()) {
  return average_phasors(recorded.image, recorded.frame, modulation, pixel_rays(wide_camera()),
                         limits);
}

double share_within(const ImageF& range_m, const ImageF& truth_m, float error_m) {
  return static_cast<double>(((range_m - truth_m).abs() <= error_m).count()) /
         static_cast<double>(truth_m.size());
}

float median_error(const ImageF& range_m, const ImageF& truth_m) {
  const ImageF off = (range_m - truth_m).abs();
  std::vector<float> values(off.data(), off.data() + off.size());
  return median(values);
}

TEST(PhasorMean, FindsRangesThatNoiseOfMoreThanARadianHides) {
  const ImageF truth_m = slanted_wall();
  for (const float sigma_rad : {1.35F, 1.6F}) {
    for (unsigned seed = 900; seed < 905; ++seed) {
      const Recorded noisy = recorded(truth_m, sigma_rad, seed);
      EXPECT_LT(share_within(noisy.image.range_m, truth_m, 0.3F), 0.35);
      EXPECT_GT(share_within(averaged(noisy).range_m, truth_m, 0.3F), 0.97) << seed;
    }
  }
}

TEST(PhasorMean, TakesAllOfThreeFrequencies) {
  const ImageF truth_m = slanted_wall();
  std::vector<float> deviations;
  float error_of_three_m = 0;
  float error_of_two_m = 0;
  for (unsigned seed = 900; seed < 905; ++seed) {
    const Recorded noisy = recorded(truth_m, 1.2F, seed, three());
    EXPECT_LT(share_within(noisy.image.range_m, truth_m, 0.2F), 0.45);
    const RangeImage out = averaged(noisy, {}, three());
    EXPECT_GT(share_within(out.range_m, truth_m, 0.2F), 0.97) << seed;
    const ImageF off = (out.range_m - truth_m).abs() / out.sigma_m;
    deviations.insert(deviations.end(), off.data(), off.data() + off.size());
    Recorded without = noisy;
    without.frame.phases.pop_back();
    const RangeImage of_two = averaged(without, {}, {80e6, 16e6});
    error_of_three_m += median_error(out.range_m, truth_m);
    error_of_two_m += median_error(of_two.range_m, truth_m);
  }
  // 120 MHz alone is 1.5 times as exact as 80 MHz, and both 1.8 times; edges of the image, where
  // slopes are uncertain, differ less.
  EXPECT_LT(error_of_three_m, 0.75F * error_of_two_m);
  const float ratio = median(deviations) / 0.6745F;
  EXPECT_GT(ratio, 0.7F);
  EXPECT_LT(ratio, 1.3F);
}

TEST(PhasorMean, KeepsSurfacesApart) {
  const ImageF truth_m = two_walls();
  for (unsigned seed = 900; seed < 905; ++seed) {
    const RangeImage out = averaged(recorded(truth_m, 1.35F, seed));
    // Blurred over a window of 12 pixels a fifth of the pixels would be on neither wall.
    EXPECT_GT(share_within(out.range_m, truth_m, 0.3F), 0.92) << seed;
    // Three pixels from the edge a pixel is on its wall.
    const double left = share_within(out.range_m.leftCols(29), truth_m.leftCols(29), 0.4F);
    const double right = share_within(out.range_m.rightCols(29), truth_m.rightCols(29), 0.4F);
    EXPECT_GT(std::min(left, right), 0.94) << seed;
  }
}

TEST(PhasorMean, TellsTheNoiseThatIsLeft) {
  const ImageF truth_m = slanted_wall();
  for (const float sigma_rad : {0.9F, 1.35F, 1.6F}) {
    std::vector<float> deviations;
    for (unsigned seed = 900; seed < 910; ++seed) {
      const RangeImage out = averaged(recorded(truth_m, sigma_rad, seed));
      const ImageF off = (out.range_m - truth_m).abs() / out.sigma_m;
      deviations.insert(deviations.end(), off.data(), off.data() + off.size());
    }
    // Of a normal half lie within 0.6745. Windows share pixels: each image holds some 30
    // independent ranges, of ten images 5 % of uncertainty are left; slopes and counts add bias.
    const float ratio = median(deviations) / 0.6745F;
    EXPECT_GT(ratio, 0.7F) << sigma_rad;
    EXPECT_LT(ratio, 1.3F) << sigma_rad;
  }
}

TEST(PhasorMean, TellsHowManyPixelsShareTheNoise) {
  const ImageF truth_m = slanted_wall();
  const Recorded noisy = recorded(truth_m, 1.35F, 900);
  const RangeImage out = averaged(noisy);
  const float middle = out.averaged(24, 32);
  EXPECT_GT(middle, 50);
  EXPECT_LT(middle, 16 * 16 * std::numbers::pi_v<float>);
  EXPECT_LT(out.averaged(0, 0), 0.6F * middle);
  EXPECT_EQ(noisy.image.averaged(24, 32), 1);
}

TEST(PhasorMean, MendsCountsThatTheSurfaceDoesNotShare) {
  const ImageF truth_m = slanted_wall();
  const Recorded noisy = recorded(truth_m, 1.35F, 900);
  const RangeImage out = averaged(noisy);
  const double wrong_before = 1 - share_within(noisy.image.range_m, truth_m, wavelength_a_m() / 2);
  const double wrong_after = 1 - share_within(out.range_m, truth_m, wavelength_a_m() / 2);
  EXPECT_GT(wrong_before, 0.03);
  EXPECT_LT(wrong_after, 0.005);
  const ImageF whole = (out.range_m / wavelength_a_m()).floor();
  EXPECT_TRUE((out.wrap_count.cast<float>() == whole).all());
}

TEST(PhasorMean, LeavesAQuietImageAsItIs) {
  const Recorded quiet = recorded(slanted_wall(), 0.3F, 900);
  const RangeImage out = averaged(quiet);
  EXPECT_TRUE(same_values(out.range_m, quiet.image.range_m));
  EXPECT_TRUE(same_values(out.sigma_m, quiet.image.sigma_m));
  EXPECT_EQ(out.averaged_px.size(), 0);
}

TEST(PhasorMean, LeavesQuietPixelsOfANoisyImageAsTheyAre) {
  const ImageF truth_m = slanted_wall();
  ImageF sigma_rad = ImageF::Constant(48, 64, 1.35F);
  sigma_rad.leftCols(20).setConstant(0.05F);
  const Recorded mixed = recorded(truth_m, sigma_rad, 900);
  const RangeImage out = averaged(mixed);
  EXPECT_TRUE((out.range_m.leftCols(20) == mixed.image.range_m.leftCols(20)).all());
  EXPECT_TRUE((out.averaged_px.leftCols(20) == 1).all());
  // Pixels beside them hear of them.
  const double beside_m = (out.range_m - truth_m).middleCols(20, 3).abs().mean();
  const double far_m = (out.range_m - truth_m).rightCols(20).abs().mean();
  EXPECT_LT(beside_m, 0.7 * far_m);
}

TEST(PhasorMean, LeavesTheFewNoisyPixelsOfAQuietImageToOthers) {
  ImageF sigma_rad = ImageF::Constant(48, 64, 0.05F);
  sigma_rad.leftCols(20).setConstant(1.35F);
  const Recorded mixed = recorded(slanted_wall(), sigma_rad, 900);
  EXPECT_TRUE(same_values(averaged(mixed).range_m, mixed.image.range_m));
}

TEST(PhasorMean, InventsNoRangesAndDropsNone) {
  Recorded noisy = recorded(slanted_wall(), 1.35F, 900);
  noisy.image.invalidate(7, 9, InvalidReason::low_amplitude);
  noisy.image.invalidate(0, 0, InvalidReason::no_return);
  noisy.frame.phases[0](0, 0) = noisy.frame.phases[1](0, 0) = std::nanf("");
  const RangeImage out = averaged(noisy);
  EXPECT_TRUE((out.reason == noisy.image.reason).all());
  EXPECT_TRUE((out.range_m.isNaN() == noisy.image.range_m.isNaN()).all());
  EXPECT_TRUE((out.sigma_m.isNaN() == noisy.image.sigma_m.isNaN()).all());
  EXPECT_TRUE((out.range_m.isNaN() || out.range_m > 0).all());
}

TEST(PhasorMean, IsTurnedOffByARadiusOfZero) {
  const Recorded noisy = recorded(slanted_wall(), 1.35F, 900);
  EXPECT_TRUE(same_values(averaged(noisy, {.max_radius_px = 0}).range_m, noisy.image.range_m));
}

TEST(PhasorMean, RefusesImagesThatDifferInSize) {
  const Recorded noisy = recorded(slanted_wall(), 1.35F, 900);
  EXPECT_THROW(
      average_phasors(noisy.image, noisy.frame, far_apart(), pixel_rays(test::camera()), {}),
      UsageError);
  Frame other = noisy.frame;
  other.phases[1] = ImageF::Zero(48, 63);
  EXPECT_THROW(average_phasors(noisy.image, other, far_apart(), pixel_rays(wide_camera()), {}),
               UsageError);
  EXPECT_THROW(average_phasors(noisy.image, noisy.frame, three(), pixel_rays(wide_camera()), {}),
               UsageError);
}

}  // namespace
}  // namespace tofmap
