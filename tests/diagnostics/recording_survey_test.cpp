// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simulation/sample_scenes.hpp"
#include "support/temporary_folder.hpp"

#include <cmath>
#include <functional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/core/frame_masks.hpp>
#include <tofmap/diagnostics/camera_warning.hpp>
#include <tofmap/diagnostics/recording_survey.hpp>
#include <tofmap/simulation/simulator.hpp>

namespace tofmap {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A recording of a simulated room, spoilt on its way.
class Survey : public testing::Test {
 protected:
  static constexpr int frame_count = 6;

  static SimulatorOptions options() {
    SimulatorOptions options;
    options.width_px = 88;
    options.height_px = 72;
    options.subpixels = 1;
    options.frames = frame_count;
    return options;
  }

  void record(const std::function<void(Frame&)>& spoil,
              const std::function<void(SensorModel&)>& mislabel = {}) {
    const Simulator simulator(make_scene("room"), options());
    SensorModel sensor = simulator.sensor();
    if (mislabel) mislabel(sensor);
    SequenceWriter writer(folder_.path() / "recording", sensor);
    for (int i = 0; i < frame_count; ++i) {
      Frame frame = simulator.simulate(i).frame;
      if (spoil) spoil(frame);
      writer.add(frame);
    }
  }

  RecordingSurvey survey(const CameraCalibration& calibration = {}) {
    const SequenceReader reader(folder_.path() / "recording", calibration);
    RecordingSurvey found = survey_recording(reader);
    warnings_ = warnings_about(found, reader.sensor());
    return found;
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST_F(Survey, FindsNothingWrongWithAGoodRecording) {
  record({});
  const RecordingSurvey found = survey();
  EXPECT_EQ(found.frames, frame_count);
  ASSERT_EQ(found.residuals.size(), 1U);
  EXPECT_NEAR(found.residuals.front().offset_m, 0, 0.01);
  EXPECT_NEAR(found.median_period_s, 1 / options().frame_rate_hz, 1e-3);
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(Survey, WarnsOfFrequenciesThatAreSwapped) {
  record({}, [](SensorModel& sensor) {
    std::swap(sensor.modulation.frequencies_hz[0], sensor.modulation.frequencies_hz[1]);
  });
  survey();
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("mixed up")));
}

TEST_F(Survey, WarnsOfImagesThatDoNotBelongTogether) {
  // As with a device that takes A and B in turn, and is said to deliver both in one image.
  record([](Frame& frame) {
    const Eigen::Index half = frame.phases[0].rows() / 2;
    frame.phases[1].topRows(half) = frame.phases[0].bottomRows(half);
    frame.phases[0].bottomRows(half).setConstant(std::nanf(""));
  });
  survey();
  EXPECT_THAT(warnings_, Contains(HasSubstr("different places")));
}

TEST_F(Survey, WarnsOfDepthAlongTheAxis) {
  const ImageF cosine = pixel_rays(Simulator(make_scene("room"), options()).sensor().camera).z;
  record([&](Frame& frame) {
    frame.phases[0] *= cosine;
    frame.phases[1] *= cosine;
  });
  survey();
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("optical axis")));
}

TEST_F(Survey, WarnsOfNoWallForItsNoise) {
  SimulatorOptions noisy = options();
  noisy.range_noise_m = 0.02;  // 5 cm at 8 m
  const Simulator simulator(test::facing_wall_scene(8, 0.5), noisy);
  const auto residuals = survey_residuals({simulator.simulate(0).frame}, simulator.sensor());
  ASSERT_EQ(residuals.size(), 1U);
  EXPECT_GT(residuals.front().spread_m, 0.06);
  EXPECT_FALSE(pairing_warning(residuals.front()));
  EXPECT_FALSE(offset_warning(residuals.front(), nullptr));
}

TEST_F(Survey, EstimatesByHowMuchThePhaseOffsetsDiffer) {
  record({});
  const Modulation modulation = Simulator(make_scene("room"), options()).sensor().modulation;
  const double ambiguity_m = modulation.wavelength_m(0) - modulation.wavelength_m(1);
  for (const double offset_m : {0.03, 0.08, 0.15, 0.2, 0.3, -0.1}) {
    CameraCalibration wrong;
    wrong.errors.resize(2);
    wrong.errors[1].offset_m = offset_m;  // taken out of B, which had none
    const RecordingSurvey found = survey(wrong);
    EXPECT_NEAR(found.residuals.front().offset_m, offset_m, 0.01);
    const bool is_small = std::abs(offset_m) < ambiguity_m / 4;
    if (is_small) {
      EXPECT_THAT(warnings_, IsEmpty()) << offset_m;
      EXPECT_THAT(remarks_about(found.errors), Contains(HasSubstr("offset between"))) << offset_m;
    } else {
      EXPECT_THAT(warnings_, Contains(HasSubstr("phase offset"))) << offset_m;
    }
  }
  // One wrap more of both, and A measures more: only known ranges tell that it is less.
  CameraCalibration wrong;
  wrong.errors.resize(2);
  wrong.errors[1].offset_m = -0.2;
  const RecordingSurvey found = survey(wrong);
  EXPECT_NEAR(found.residuals.front().offset_m, ambiguity_m - 0.2, 0.01);
  ASSERT_FALSE(found.residuals.front().other_offsets_m.empty());
  EXPECT_NEAR(found.residuals.front().other_offsets_m.front(), -0.2, 0.01);
}

ResidualSurvey residual_of(double offset_m) {
  ResidualSurvey residual;
  residual.offset_m = offset_m;
  residual.other_offsets_m = {offset_m + 0.33};
  residual.ambiguity_m = 0.33;
  return residual;
}

CameraErrors camera_of(double offset_m) {
  CameraErrors camera;
  camera.coefficient_m.front() = offset_m;
  camera.frames = 10;
  return camera;
}

TEST(CameraWarning, IsOfUnequalFocalLengths) {
  CameraModel camera;
  camera.fx_px = 64;
  camera.fy_px = 70;
  EXPECT_FALSE(camera_warning(camera));
  camera.fy_px = 640;
  EXPECT_THAT(camera_warning(camera).value_or(""), HasSubstr("fx 64.0 px and fy 640.0 px"));
}

TEST(ErrorTally, LeavesOutFlowsThatAreNoMotion) {
  MeasuredFrame frame;
  frame.returns.phases.assign(2, ImageF::Zero(72, 88));
  frame.errors.resize(2);
  frame.errors[1].pixels = 1000;
  ErrorTally tally;
  for (const double flow_px : {2.0, 3.0, 4.0, 60.0, 60.0, 60.0, 60.0}) {
    frame.errors[1].flow_px = flow_px;
    tally.add(frame);
  }
  EXPECT_EQ(tally.survey().flow_px, 3);
  EXPECT_EQ(tally.survey().frames, 7);
}

TEST(OffsetWarning, IsThereWhereUnwrappingDidNotFindTheSameSmallOffset) {
  const CameraErrors small = camera_of(0.05);
  EXPECT_FALSE(offset_warning(residual_of(0.06), &small)) << "both agree";
  EXPECT_THAT(offset_warning(residual_of(0.06), nullptr).value_or(""), HasSubstr("60 mm more"));
  EXPECT_FALSE(offset_warning(residual_of(0.01), nullptr)) << "motion makes as much";
  const CameraErrors other = camera_of(-0.05);
  EXPECT_THAT(offset_warning(residual_of(0.06), &other).value_or(""),
              AllOf(HasSubstr("50 mm less"), HasSubstr("60 mm more")));
  const CameraErrors large = camera_of(0.15);
  EXPECT_THAT(offset_warning(residual_of(0.15), &large).value_or(""), HasSubstr("or 480 mm more"))
      << "an alias is nearly as likely";
  constexpr bool map_agrees = true;
  EXPECT_FALSE(offset_warning(residual_of(0.15), &large, map_agrees)) << "no alias makes a map";
  EXPECT_FALSE(offset_warning(residual_of(0.1), &small, map_agrees)) << "noise makes as much";
  EXPECT_TRUE(offset_warning(residual_of(0.1), &small)) << "estimates disagree";
  EXPECT_TRUE(offset_warning(residual_of(0.06), &other, map_agrees)) << "even then";
}

TEST(FrequencyWarning, IsThereWhereOneWavelengthIsAllThatTheFrequenciesTell) {
  EXPECT_FALSE(frequency_warning({{}, {29e6, 31e6}}));
  EXPECT_FALSE(frequency_warning({{}, {80e6, 100e6}}));
  EXPECT_THAT(frequency_warning({{}, {29e6, 29.001e6}}).value_or(""),
              HasSubstr("cannot tell wrap counts apart"));
  EXPECT_THAT(frequency_warning({{}, {15e6}}).value_or(""),
              HasSubstr("cannot tell wrap counts apart"));
  EXPECT_FALSE(frequency_warning({{}, {15e6}}, 9)) << "within the wavelength of 9.99 m";
}

TEST(FrequencyWarning, IsTheSameInEveryOrder) {
  EXPECT_FALSE(frequency_warning({{}, {20e6, 100e6}}));
  EXPECT_FALSE(frequency_warning({{}, {100e6, 20e6}}));
}

TEST(SaturatedPixels, AreNoneWithoutALimit) {
  Frame frame = blank_frame(1);
  frame.phases[0] = ImageF::Constant(2, 3, 0.5F);
  frame.amplitudes = {ImageF::Constant(2, 3, 100)};
  EXPECT_EQ(saturated_pixels(frame, 0).count(), 0);
  EXPECT_EQ(saturated_pixels(frame, 100).count(), 6);
}

TEST(OrderWarning, IsThereIfTheFirstWavelengthIsMuchLongerThanAnother) {
  EXPECT_FALSE(order_warning({29e6, 31e6}));
  EXPECT_FALSE(order_warning({80e6, 16e6, 120e6}));
  EXPECT_FALSE(order_warning({30e6}));
  EXPECT_THAT(order_warning({16e6, 80e6}).value_or(""), HasSubstr("9.37 m"));
}

TEST(ErrorWarnings, BeginAtACentimetreOfPeriodicError) {
  ErrorSurvey survey;
  survey.cameras.resize(2);
  survey.cameras[1].frames = 10;
  survey.cameras[1].periodic_rms_m = 0.009;
  EXPECT_THAT(warnings_about(survey), IsEmpty());
  survey.cameras[1].periodic_rms_m = 0.011;
  EXPECT_THAT(warnings_about(survey), ElementsAre(HasSubstr("about 11 mm")));
  constexpr bool map_agrees = true;
  EXPECT_THAT(warnings_about(survey, map_agrees), IsEmpty());
  survey.cameras[1].periodic_rms_m = 0.026;
  EXPECT_THAT(warnings_about(survey, map_agrees), ElementsAre(HasSubstr("about 26 mm")));
  survey.cameras[1].frames = 0;
  EXPECT_THAT(warnings_about(survey), IsEmpty()) << "nothing is known";
}

TEST_F(Survey, WarnsOfImagesOfOneFrequencyThatRepeat) {
  ImageF first;
  record([&](Frame& frame) {
    if (first.size() == 0) first = frame.phases[1];
    frame.phases[1] = first;
  });
  const RecordingSurvey found = survey();
  EXPECT_EQ(found.repeated, 0);
  EXPECT_EQ(found.repeated_single, found.frames - 1);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("at one frequency, and new phases at another")));
}

TEST_F(Survey, NamesImagesOfOnePhase) {
  record([](Frame& frame) {
    if (frame.index == 2) frame.phases[1].setConstant(0.25F);
  });
  EXPECT_THAT(survey().constant_images, ElementsAre(HasSubstr("phase_b/000002.png")));
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("phase_b/000002.png")));
}

TEST_F(Survey, CountsFramesThatRepeat) {
  Frame first = blank_frame(2);
  record([&](Frame& frame) {
    if (frame.index == 0) first = frame;
    if (frame.index != 1 && frame.index != 2) return;
    frame.phases[0] = first.phases[0];
    frame.phases[1] = frame.index == 1 ? first.phases[1] : frame.phases[1];
  });
  EXPECT_EQ(survey().repeated, 1);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("1 frame repeats"),
                                     HasSubstr("1 frame has the phases of the previous frame")));
}

TEST_F(Survey, CountsFramesWithoutAnyReturn) {
  record([](Frame& frame) {
    if (frame.index == 3) frame.phases[0].setConstant(NAN);
  });
  EXPECT_EQ(survey().without_return, 1);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("camera covered")));
}

TEST_F(Survey, DoesNotTakeACoveredCameraForOneThatRepeats) {
  record([](Frame& frame) {
    if (frame.index < 2) return;
    frame.phases[0].setConstant(NAN);
    frame.phases[1].setConstant(NAN);
  });
  EXPECT_EQ(survey().repeated, 0);
  EXPECT_EQ(survey().without_return, 4);
}

TEST_F(Survey, TellsPhasesFromAmplitudes) {
  constexpr float full_scale = 60000;
  record([&](Frame& frame) {
    const Frame recorded = frame;
    frame.phases[0] = recorded.amplitudes[0] / full_scale;
    frame.phases[1] = recorded.amplitudes[1] / full_scale;
    frame.amplitudes[0] = recorded.phases[0].isNaN().select(0.0F, recorded.phases[0] * full_scale);
    frame.amplitudes[1] = recorded.phases[1].isNaN().select(0.0F, recorded.phases[1] * full_scale);
  });
  survey();
  EXPECT_THAT(warnings_, Contains(HasSubstr("phases and amplitudes are mixed up")));
}

TEST_F(Survey, TellsHowMuchIsSaturated) {
  record([](Frame& frame) { frame.amplitudes[0].topRows(18).setConstant(65535); });
  EXPECT_NEAR(survey().saturated_share, 0.25, 1e-9);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("25 % of the pixels are saturated")));
}

TEST_F(Survey, WarnsOfTimesInMilliseconds) {
  record([](Frame& frame) { frame.timestamp_s *= 1000; });
  survey();
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("seconds?")));
}

TEST_F(Survey, NamesAGapInTime) {
  record([](Frame& frame) { frame.timestamp_s += frame.index > 3 ? 2 : 0; });
  EXPECT_EQ(survey().frame_before_gap, 3);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("after frame 3")));
}

}  // namespace
}  // namespace tofmap
