// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/sample_frames.hpp"
#include "support/temporary_folder.hpp"

#include <cmath>
#include <filesystem>
#include <random>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/calibration/fixed_pattern_fit.hpp>
#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

constexpr int width_px = 44;
constexpr int height_px = 36;

/// A camera in front of flat walls that face it, without errors other than pattern and noise.
class WalledCamera {
 public:
  WalledCamera(Modulation modulation, double pattern_m, unsigned seed) : random_(seed) {
    sensor_.modulation = std::move(modulation);
    sensor_.camera = {.width_px = width_px,
                      .height_px = height_px,
                      .fx_px = 32,
                      .fy_px = 32,
                      .cx_px = 21.5,
                      .cy_px = 17.5};
    for (std::size_t f = 0; f < sensor_.modulation.count(); ++f) {
      pattern_.push_back(ImageF::NullaryExpr(
          height_px, width_px, [&] { return static_cast<float>(pattern_m * normal_(random_)); }));
    }
  }

  /// Adds a frame of a wall at this range. The amplitude falls from the left to the right by a
  /// factor of four; the noise is `noise_m` in the middle.
  void see_wall(double range_m, double noise_m, double outliers = 0) {
    Frame frame = blank_frame(pattern_.size());
    frame.index = static_cast<int>(frames_.size());
    const ImageF reference_m = ImageF::Constant(height_px, width_px, static_cast<float>(range_m));
    for (std::size_t f = 0; f < pattern_.size(); ++f) {
      const double wavelength_m = sensor_.modulation.wavelength_m(f);
      frame.phases[f].resize(height_px, width_px);
      frame.amplitudes[f].resize(height_px, width_px);
      for (Eigen::Index i = 0; i < reference_m.size(); ++i) {
        const double darkness =
            std::pow(4.0, (static_cast<double>(i % width_px) + 0.5) / width_px - 0.5);
        double error_m = pattern_[f].data()[i] + noise_m * darkness * normal_(random_);
        if (share_(random_) < outliers) error_m += 0.12;
        const double cycles = (range_m + error_m) / wavelength_m;
        frame.phases[f].data()[i] = static_cast<float>(cycles - std::floor(cycles));
        frame.amplitudes[f].data()[i] = static_cast<float>(1000 / darkness);
      }
    }
    frames_.push_back({std::move(frame), reference_m, {}});
  }

  /// Walls at distances that differ by more than a wavelength.
  void see_walls(int count, double noise_m, double outliers = 0) {
    for (int i = 0; i < count; ++i) see_wall(1 + 6.0 * i / count, noise_m, outliers);
  }

  std::vector<PatternEstimate> fit() {
    const ReferencedFrames frames = [this](const auto& visit) {
      for (const ReferencedFrame& one : frames_) visit(one);
    };
    constexpr double max_error_m = 0.15;
    return fit_fixed_pattern(frames, sensor_, max_error_m);
  }

  /// Root mean square of what the estimate leaves of the pattern, apart from a common offset.
  double left_m(const PatternEstimate& estimate, std::size_t frequency) const {
    const ImageF left = pattern_[frequency] - estimate.error_m;
    return std::sqrt((left - left.mean()).square().mean());
  }

  SensorModel sensor_;
  FixedPattern pattern_;
  std::vector<ReferencedFrame> frames_;

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> share_;
};

/// Standard deviations of 1584 pixels scatter by 1.8 %; four times that, and as much again for the
/// noise that is estimated from the same pixels.
constexpr double scatter = 0.15;

TEST(FixedPatternFit, FindsThePatternOfAnyNumberOfFrequencies) {
  for (const Modulation& modulation :
       {Modulation{29e6}, Modulation{29e6, 31e6}, Modulation{80e6, 16e6, 120e6}}) {
    WalledCamera camera(modulation, 0.01, 1);
    camera.see_walls(20, 0.02);
    const std::vector<PatternEstimate> found = camera.fit();
    ASSERT_EQ(found.size(), modulation.count());
    for (std::size_t f = 0; f < found.size(); ++f) {
      EXPECT_TRUE(found[f].is_significant());
      EXPECT_NEAR(found[f].sigma_m, 0.01, scatter * 0.01);
      EXPECT_NEAR(camera.left_m(found[f], f), found[f].remaining_m, scatter * found[f].remaining_m);
      EXPECT_LT(found[f].remaining_m, found[f].noise_m * 1.1) << "some pixels are darker";
      EXPECT_NEAR(found[f].error_m.mean(), 0, 0.0005) << "the mean belongs to the offset";
      EXPECT_EQ(found[f].pixels, 1584U);
    }
  }
}

TEST(FixedPatternFit, ComesNearerWithMoreFrames) {
  double before_m = 0.01;  // of the pattern itself
  for (const int frames : {5, 20, 80}) {
    WalledCamera camera({29e6, 31e6}, 0.01, 2);
    camera.see_walls(frames, 0.02);
    const double left_m = camera.left_m(camera.fit()[1], 1);
    EXPECT_LT(left_m, 0.75 * before_m) << frames;
    before_m = left_m;
  }
}

TEST(FixedPatternFit, DoesNotTakeNoiseOfFewFramesForAPattern) {
  for (const double pattern_m : {0.0, 0.001}) {
    for (const int frames : {1, 2, 3, 10}) {
      WalledCamera camera({29e6, 31e6}, pattern_m, 3);
      camera.see_walls(frames, 0.02);
      for (const PatternEstimate& found : camera.fit()) {
        EXPECT_FALSE(found.is_significant()) << frames;
        EXPECT_EQ(found.error_m.abs().maxCoeff(), 0) << frames;
        EXPECT_EQ(std::isnan(found.noise_m), frames == 1) << "nothing tells the noise";
      }
    }
  }
}

TEST(FixedPatternFit, NeverLeavesMoreThanThereWas) {
  for (const double pattern_m : {0.0, 0.001, 0.003, 0.01}) {
    for (const int frames : {1, 2, 3, 5, 10}) {
      WalledCamera camera({29e6}, pattern_m, 4);
      camera.see_walls(frames, 0.02);
      EXPECT_LT(camera.left_m(camera.fit()[0], 0), 1.01 * pattern_m + 1e-9)
          << pattern_m << " m, " << frames;
    }
  }
}

TEST(FixedPatternFit, LeavesOutOutliers) {
  WalledCamera camera({29e6, 31e6}, 0.01, 5);
  camera.see_walls(20, 0.01, 0.05);
  WalledCamera clean({29e6, 31e6}, 0.01, 5);
  clean.see_walls(20, 0.01);
  // Outliers of 12 cm, one in 20, would add 6 mm to the error of the mean of 20 frames.
  EXPECT_LT(camera.left_m(camera.fit()[0], 0), 1.3 * clean.left_m(clean.fit()[0], 0));
}

TEST(FixedPatternFit, LeavesOutSaturatedPixelsAndThoseWithoutReturnOrReference) {
  WalledCamera camera({29e6, 31e6}, 0.01, 6);
  camera.see_walls(10, 0.005);
  camera.sensor_.saturation_amplitude = 3000;
  for (auto& [frame, reference_m, change_m] : camera.frames_) {
    frame.phases[0](0, 0) = nan;
    reference_m(1, 0) = nan;
    frame.amplitudes[1](2, 0) = 3000;
  }
  const std::vector<PatternEstimate> found = camera.fit();
  const auto is_known = [&](std::size_t f, Eigen::Index row) {
    return !std::isnan(found[f].error_m(row, 0));
  };
  EXPECT_FALSE(is_known(0, 0));
  EXPECT_TRUE(is_known(1, 0)) << "the other frequency has a return";
  EXPECT_FALSE(is_known(0, 1));
  EXPECT_FALSE(is_known(1, 1));
  EXPECT_TRUE(is_known(0, 2)) << "the other frequency is not saturated";
  EXPECT_FALSE(is_known(1, 2));
  EXPECT_EQ(found[0].pixels, 1582U);
}

TEST(FixedPatternFit, WorksWithoutAmplitudes) {
  WalledCamera camera({29e6, 31e6}, 0.01, 7);
  camera.see_walls(20, 0.01);
  for (ReferencedFrame& one : camera.frames_) one.frame.amplitudes.clear();
  const PatternEstimate found = camera.fit()[0];
  EXPECT_NEAR(found.sigma_m, 0.01, scatter * 0.01);
  EXPECT_LT(camera.left_m(found, 0), 0.004);
}

TEST(FixedPatternFit, TellsHowMuchOfAPeriodicErrorIsLeft) {
  WalledCamera still({29e6, 31e6}, 0.01, 8);
  for (int i = 0; i < 10; ++i) still.see_wall(2, 0.01);
  EXPECT_NEAR(still.fit()[0].periodic_share, 1, 1e-6);
  WalledCamera moving({29e6, 31e6}, 0.01, 8);
  const double period_m = moving.sensor_.modulation.wavelength_m(0) / 4;
  for (int i = 0; i < 10; ++i) moving.see_wall(2 + i * period_m / 10, 0.01);
  EXPECT_NEAR(moving.fit()[0].periodic_share, 0, 0.15);  // weights differ a little after outliers
}

TEST(FixedPatternFit, TakesOutTheMotionUntilALaterExposure) {
  // The camera moves forward and pans, so that ranges shrink by up to 9 cm, more on one side.
  WalledCamera camera({29e6, 31e6}, 0.005, 11);
  camera.see_walls(30, 0.01);
  constexpr float delay_frames = 0.5;
  const ImageF across = ImageF::NullaryExpr(height_px, width_px, [](Eigen::Index, Eigen::Index u) {
    return static_cast<float>(u) / width_px;
  });
  for (std::size_t i = 0; i < camera.frames_.size(); ++i) {
    ReferencedFrame& one = camera.frames_[i];
    one.change_m = -0.03F * across * static_cast<float>(1 + i % 3);
    one.change_m(3, 3) = nan;
    one.change_m(4, 4) = 2;  // an edge
    const auto wavelength_m = static_cast<float>(camera.sensor_.modulation.wavelength_m(1));
    const ImageF moved =
        one.change_m.isNaN().select(0, one.change_m) * (delay_frames / wavelength_m);
    one.frame.phases[1] += (one.change_m > 1).select(0, moved);
    one.frame.phases[1] -= one.frame.phases[1].floor();
  }
  const std::vector<PatternEstimate> found = camera.fit();
  EXPECT_NEAR(found[0].delay_frames, 0, 0.05);
  EXPECT_NEAR(found[1].delay_frames, delay_frames, 0.05);
  for (std::size_t f = 0; f < 2; ++f) {
    EXPECT_NEAR(camera.left_m(found[f], f), found[f].remaining_m, scatter * found[f].remaining_m);
  }
}

TEST(FixedPatternFit, NeedsReferencesOfTheImagesSize) {
  WalledCamera camera({29e6}, 0.01, 9);
  camera.see_walls(2, 0.01);
  camera.frames_[1].reference_m.resize(height_px, width_px - 1);
  EXPECT_THROW(camera.fit(), UsageError);
}

TEST(FixedPatternFit, OfNoFramesIsNotSignificant) {
  WalledCamera camera({29e6, 31e6}, 0.01, 10);
  const std::vector<PatternEstimate> found = camera.fit();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_FALSE(found[0].is_significant());
  EXPECT_EQ(found[0].pixels, 0U);
  EXPECT_TRUE(found[0].error_m.isNaN().all());
}

class ReferencedFramesTest : public testing::Test {
 protected:
  ReferencedFramesTest() {
    SequenceWriter writer(folder_.path(), test::sample_sensor());
    for (int i = 0; i < 4; ++i) writer.add(test::sample_frame(i));
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReferencedFramesTest, AreThoseThatAreReadableAndHaveAReference) {
  const SequenceReader recording(folder_.path());
  std::filesystem::resize_file(folder_.path() / "phase_a/000001.png", 10);
  const ReferenceRanges all_but_0 = [](const Frame& frame) {
    return frame.index == 0 ? std::nullopt : std::make_optional(test::sample_range_truth());
  };
  const ReferencedFrames frames = referenced_frames(recording, {0, 1, 3}, all_but_0, {});
  for (int time = 0; time < 2; ++time) {
    std::vector<int> given;
    frames([&](const ReferencedFrame& one) {
      given.push_back(one.frame.index);
      EXPECT_TRUE(same_values(one.reference_m, test::sample_range_truth()));
    });
    EXPECT_THAT(given, testing::ElementsAre(3)) << "time " << time;
  }
}

TEST_F(ReferencedFramesTest, AreCalibrated) {
  const SequenceReader recording(folder_.path());
  CameraCalibration calibration;
  calibration.errors = {{.offset_m = 0.5}};
  const ReferenceRanges reference = [](const Frame&) {
    return std::make_optional(test::sample_range_truth());
  };
  Frame expected = *recording.read(2).frame;
  calibrate(expected, recording.sensor().modulation, calibration);
  int given = 0;
  referenced_frames(recording, {2}, reference, calibration)([&](const ReferencedFrame& one) {
    EXPECT_TRUE(same_values(one.frame.phases[0], expected.phases[0]));
    ++given;
  });
  EXPECT_EQ(given, 1);
}

TEST_F(ReferencedFramesTest, KnowHowRangesChangeUntilTheNextFrame) {
  const SequenceReader recording(folder_.path());
  const ReferenceRanges receding = [](const Frame& frame) {
    return std::make_optional<ImageF>(test::sample_range_truth() + 0.25F * frame.index);
  };
  std::vector<float> changes_m;
  referenced_frames(recording, {0, 2, 3}, receding, {})([&](const ReferencedFrame& one) {
    changes_m.push_back(one.change_m.size() == 0 ? -1 : one.change_m(0, 0));
  });
  EXPECT_THAT(changes_m, testing::ElementsAre(0.25F, 0.25F, -1)) << "none follows the last one";
}

TEST_F(ReferencedFramesTest, EndWhenTheCallerWantsNoMore) {
  const SequenceReader recording(folder_.path());
  const ReferenceRanges reference = [](const Frame&) {
    return std::make_optional(test::sample_range_truth());
  };
  int asked = 0;
  int given = 0;
  referenced_frames(recording, {0, 1, 2, 3}, reference, {},
                    [&] { return ++asked < 3; })([&](const ReferencedFrame&) { ++given; });
  EXPECT_EQ(given, 2);
}

}  // namespace
}  // namespace tofmap
