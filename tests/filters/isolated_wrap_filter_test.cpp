// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "range_images.hpp"

#include <gtest/gtest.h>

#include <tofmap/core/error.hpp>
#include <tofmap/filters/isolated_wrap_filter.hpp>

namespace tofmap {
namespace {

using test::frame_of;
using test::modulation;
using test::plane;

const auto wavelength_m = static_cast<float>(modulation().wavelength_m(0));

/// A wall within the second wavelength, and what is measured of it.
struct Wall {
  RangeImage image = plane(6);
  Frame frame = blank_frame(2);

  Wall() {
    image.wrap_count = (image.range_m / wavelength_m).cast<std::uint8_t>();
    frame = frame_of(image.range_m);
  }

  /// Gives a block of pixels, whatever they measured, that many wraps too many.
  void miscount(int row, int col, int rows, int cols, int wraps) {
    for (int v = row; v < row + rows; ++v) {
      for (int u = col; u < col + cols; ++u) {
        image.wrap_count(v, u) = static_cast<std::uint8_t>(image.wrap_count(v, u) + wraps);
        image.range_m(v, u) += static_cast<float>(wraps) * wavelength_m;
      }
    }
  }

  RangeImage mended(double max_share = 0.05) const {
    return mend_isolated_wraps(image, frame, modulation(), {.max_share = max_share});
  }
};

TEST(IsolatedWrapFilter, CorrectsARegionThatIsAWavelengthOff) {
  for (const int wraps : {-1, 1, 2}) {
    Wall wall;
    const RangeImage truth = wall.image;
    wall.image.confidence(6, 8) = 0.1F;
    wall.miscount(5, 7, 3, 4, wraps);
    const RangeImage out = wall.mended();
    EXPECT_TRUE((out.wrap_count == truth.wrap_count).all()) << wraps;
    EXPECT_LT((out.range_m - truth.range_m).abs().maxCoeff(), 1e-4F) << wraps;
    EXPECT_FLOAT_EQ(out.confidence(6, 8), 0.9F) << "that of the surroundings";
    EXPECT_EQ(out.count_valid(), 20 * 16) << wraps;
  }
}

/// Whether a region that is a wavelength of A off is corrected although the frequencies `f` and A
/// differ by this many standard deviations of their phase noise there, in the wrong direction.
bool is_corrected_against(const Modulation& frequencies, std::size_t f, double sigmas) {
  constexpr double noise_cycles = 0.02;
  const double mean_m = mean_wavelength_m(frequencies);
  RangeImage image = plane(6, static_cast<float>(noise_cycles * mean_m));
  const auto a_m = static_cast<float>(frequencies.wavelength_m(0));
  image.wrap_count = (image.range_m / a_m).cast<std::uint8_t>();
  Frame frame = frame_of(image.range_m, frequencies);
  const double ratio = a_m / frequencies.wavelength_m(f);
  // The residual of the right wrap count, and that of the count that the region has.
  const double shift = ratio - std::round(ratio);
  const double residual = std::copysign(sigmas * noise_cycles * std::hypot(1, ratio), shift);
  frame.phases[f](8, 10) =
      std::fmod(frame.phases[f](8, 10) + static_cast<float>(residual) + 1, 1.0F);
  image.wrap_count(8, 10) = static_cast<std::uint8_t>(image.wrap_count(8, 10) + 1);
  image.range_m(8, 10) += a_m;
  const RangeImage out = mend_isolated_wraps(image, frame, frequencies, {.max_share = 0.05});
  EXPECT_TRUE(out.sigma_m(8, 10) == image.sigma_m(8, 10) ||
              std::abs(out.sigma_m(8, 10) / (noise_cycles * a_m) - 1) < 1e-5)
      << "noise of A alone";
  return out.wrap_count(8, 10) < image.wrap_count(8, 10);
}

TEST(IsolatedWrapFilter, TakesTheNoiseOfEachFrequencyForWhatItIs) {
  const Modulation kinect{80e6, 16e6, 120e6};
  // The shift of 120 MHz by a wrap is half a cycle, so both counts cost the most, 4.5 nats.
  EXPECT_TRUE(is_corrected_against(kinect, 2, 1));
  EXPECT_TRUE(is_corrected_against(kinect, 1, 2));
  EXPECT_TRUE(is_corrected_against({16e6, 80e6, 120e6}, 1, 1));
}

TEST(IsolatedWrapFilter, CorrectsAtTheBorderOfTheImage) {
  Wall wall;
  const RangeImage truth = wall.image;
  wall.miscount(0, 0, 2, 3, 1);
  EXPECT_TRUE((wall.mended().wrap_count == truth.wrap_count).all());
}

TEST(IsolatedWrapFilter, LeavesAnObjectThatIsAWavelengthBefore) {
  Wall wall;
  wall.miscount(5, 7, 3, 4, -1);
  // It does stand there: the residual agrees.
  const RangeImage before = wall.image;
  wall.frame = frame_of(wall.image.range_m);
  EXPECT_TRUE((wall.mended().wrap_count == before.wrap_count).all());
  EXPECT_EQ(wall.mended().count_valid(), 20 * 16);
}

TEST(IsolatedWrapFilter, DropsARegionThatFitsNothing) {
  Wall wall;
  wall.miscount(5, 7, 3, 4, 2);
  wall.frame = frame_of(wall.image.range_m);  // the residual says two more,
  wall.miscount(5, 7, 3, 4, -1);              // the image one, and the surroundings none
  const RangeImage out = wall.mended();
  EXPECT_EQ(out.count_valid(), 20 * 16 - 12);
  EXPECT_EQ(count_reason(out, InvalidReason::isolated_wrap), 12);
  EXPECT_FALSE(out.valid(5, 7));
}

TEST(IsolatedWrapFilter, LeavesWhatIsLarge) {
  Wall wall;
  wall.miscount(5, 7, 4, 4, 1);  // 5 % of the image
  const RangeImage before = wall.image;
  EXPECT_TRUE((wall.mended(0.049).wrap_count == before.wrap_count).all());
  EXPECT_FALSE((wall.mended(0.051).wrap_count == before.wrap_count).all());
}

TEST(IsolatedWrapFilter, LeavesAStepThatIsNoWholeWavelength) {
  Wall wall;
  wall.miscount(5, 7, 3, 4, -1);
  for (int v = 5; v < 8; ++v) {
    for (int u = 7; u < 11; ++u) wall.image.range_m(v, u) += 0.4F * wavelength_m;
  }
  const RangeImage before = wall.image;
  EXPECT_TRUE((wall.mended().wrap_count == before.wrap_count).all());
}

TEST(IsolatedWrapFilter, LeavesAnImageThatWasNotUnwrapped) {
  Wall wall;
  wall.image.range_m = wall.frame.phases[0] * wavelength_m;
  wall.image.wrap_count.setZero();
  EXPECT_TRUE((wall.mended().wrap_count == 0).all());
}

TEST(IsolatedWrapFilter, RefusesAFrameOfAnotherSize) {
  const Wall wall;
  EXPECT_THROW(mend_isolated_wraps(wall.image, {}, modulation(), {}), UsageError);
}

}  // namespace
}  // namespace tofmap
