// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace tofmap::app {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ConsistencyDoubts, BeginBeyondTheirLimits) {
  Consistency consistency;
  consistency.contradicted_percent = 3;
  consistency.beat_misfit_percent = 10;
  EXPECT_THAT(doubts_about(consistency), IsEmpty());
  consistency.contradicted_percent = 3.1;
  EXPECT_THAT(doubts_about(consistency), ElementsAre(HasSubstr("contradict each other in 3.1 %")));
  consistency.beat_misfit_percent = 11;
  EXPECT_THAT(doubts_about(consistency), ElementsAre(HasSubstr("contradict"), HasSubstr("11 %")));
}

TEST(ConsistencyDoubts, AreNoneAboutWhatIsNotKnown) {
  EXPECT_THAT(doubts_about({NAN, NAN, NAN, NAN, NAN, NAN}), IsEmpty());
}

TEST(ConsistencyFrames, AreFewerOfLargeImagesButNotTooFew) {
  const auto frames_of = [](int width_px, int height_px) {
    CameraModel camera;
    camera.width_px = width_px;
    camera.height_px = height_px;
    return consistency_frames(camera);
  };
  EXPECT_EQ(frames_of(176, 144), 60);
  EXPECT_EQ(frames_of(500, 400), 30);
  EXPECT_EQ(frames_of(640, 480), 20);
  EXPECT_EQ(frames_of(4000, 3000), 20);
}

TEST(ConsistencyJson, TellsWhatIsNotKnown) {
  Consistency consistency;
  consistency.curl_violations_per_frame = NAN;
  const auto json = consistency_json(consistency);
  EXPECT_TRUE(json["curl_violations_per_frame"].is_null());
  EXPECT_EQ(json["contradicted_percent"], 0);
}

}  // namespace
}  // namespace tofmap::app
