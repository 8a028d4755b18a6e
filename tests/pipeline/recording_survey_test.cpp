// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "support/temporary_folder.hpp"

#include <functional>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tofmap/acquisition/simulator.hpp>
#include <tofmap/pipeline/recording_survey.hpp>

namespace tofmap {
namespace {

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

  void record(const std::function<void(DualFrequencyFrame&)>& spoil,
              const std::function<void(SensorModel&)>& mislabel = {}) {
    const Simulator simulator(make_scene("room"), options());
    SensorModel sensor = simulator.sensor();
    if (mislabel) mislabel(sensor);
    SequenceWriter writer(folder_.path() / "recording", sensor);
    for (int i = 0; i < frame_count; ++i) {
      DualFrequencyFrame frame = simulator.simulate(i).frame;
      if (spoil) spoil(frame);
      writer.add(frame);
    }
  }

  RecordingSurvey survey(const CameraCalibration& calibration = {}) {
    const SequenceReader reader(folder_.path() / "recording", calibration);
    RecordingSurvey found = survey_recording(reader);
    doubts_ = doubts_about(found, reader.sensor());
    return found;
  }

  test::TemporaryFolder folder_;
  std::vector<std::string> doubts_;
};

TEST_F(Survey, FindsNothingWrongWithAGoodRecording) {
  record({});
  const RecordingSurvey found = survey();
  EXPECT_EQ(found.frames, frame_count);
  ASSERT_TRUE(found.beat);
  EXPECT_NEAR(found.beat->offset_m, 0, 0.01);
  EXPECT_NEAR(found.median_period_s, 1 / options().frame_rate_hz, 1e-3);
  EXPECT_THAT(doubts_, IsEmpty());
}

TEST_F(Survey, DoubtsFrequenciesThatAreSwapped) {
  record({}, [](SensorModel& sensor) {
    std::swap(sensor.modulation.frequency_a_hz, sensor.modulation.frequency_b_hz);
  });
  survey();
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("mixed up")));
}

TEST_F(Survey, EstimatesByHowMuchThePhaseOffsetsDiffer) {
  record({});
  CameraCalibration wrong;
  wrong.error_b.offset_m = 0.08;  // taken out of B, which had none
  const RecordingSurvey found = survey(wrong);
  EXPECT_NEAR(found.beat->offset_m, 0.08, 0.01);
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("phase offset")));
}

TEST_F(Survey, NamesImagesOfOnePhase) {
  record([](DualFrequencyFrame& frame) {
    if (frame.index == 2) frame.phase_b.setConstant(0.25F);
  });
  EXPECT_THAT(survey().constant_images, ElementsAre(HasSubstr("phase_b/000002.png")));
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("phase_b/000002.png")));
}

TEST_F(Survey, CountsFramesThatRepeat) {
  ImageF first;
  record([&](DualFrequencyFrame& frame) {
    if (frame.index == 0) first = frame.phase_a;
    if (frame.index == 1) frame.phase_a = first;
  });
  EXPECT_EQ(survey().repeated, 1);
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("1 frames repeat")));
}

TEST_F(Survey, CountsFramesWithoutAnyReturn) {
  record([](DualFrequencyFrame& frame) {
    if (frame.index == 3) frame.phase_a.setConstant(NAN);
  });
  EXPECT_EQ(survey().without_return, 1);
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("camera covered")));
}

TEST_F(Survey, TellsHowMuchIsSaturated) {
  record([](DualFrequencyFrame& frame) { frame.amplitude_a.topRows(18).setConstant(65535); });
  EXPECT_NEAR(survey().saturated_share, 0.25, 1e-9);
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("25 % of the pixels are saturated")));
}

TEST_F(Survey, NamesAGapInTime) {
  record([](DualFrequencyFrame& frame) { frame.timestamp_s += frame.index > 3 ? 2 : 0; });
  EXPECT_EQ(survey().frame_before_gap, 3);
  EXPECT_THAT(doubts_, ElementsAre(HasSubstr("after frame 3")));
}

}  // namespace
}  // namespace tofmap
