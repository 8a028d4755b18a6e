// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
//
// What report.html says; report_page_browser.py looks at it.

#include "program.hpp"

#include <filesystem>

#include <gmock/gmock.h>

namespace tofmap::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ReportPage : public WithRecording {
 protected:
  std::string page() const { return read_text(out_ / "report.html"); }

  /// How many frames its strip has.
  static int frames_in(const std::string& page) {
    int count = 0;
    const std::string start = "<section class=\"frame\">";
    for (std::size_t i = 0; (i = page.find(start, i)) != std::string::npos; ++i) ++count;
    return count;
  }
};

TEST_F(ReportPage, OfAMapTellsVerdictFiguresAndOptions) {
  ASSERT_EQ(run("map").status, 0);
  EXPECT_THAT(
      page(),
      AllOf(HasSubstr("4 of 4 frames are in this map"),
            HasSubstr("with unwrapping (joint), coloured by height"),
            HasSubstr("the same path, ranges as measured (of 4 frames), coloured by height"),
            HasSubstr("ATE, m (RMSE)"), HasSubstr("map error, m"),
            HasSubstr("path error over time"), HasSubstr("wrong wraps over range"),
            HasSubstr("unwrap:\n  method: joint")));
  EXPECT_EQ(frames_in(page()), frames);
}

TEST_F(ReportPage, OfWrappedRangesIsNotToBeTrusted) {
  ASSERT_EQ(run("map", {"--method", "none", "--set", "report.frames=2"}).status, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("Do not trust this result."), HasSubstr("Nothing was unwrapped"),
                    Not(HasSubstr("the same path, ranges as measured"))));
  EXPECT_EQ(frames_in(page()), 2);
  const auto report = read_json(out_ / "report.json");
  EXPECT_GT(report["consistency"]["residual_misfit_percent"], 10);
  EXPECT_THAT(report["warnings"].dump(), HasSubstr("better with another wrap count"));
}

TEST_F(ReportPage, OfARightMapHasNoWarning) {
  const Finished finished = run("map");
  ASSERT_EQ(finished.status, 0);
  EXPECT_THAT(finished.out, Not(HasSubstr("warning")));
  const auto report = read_json(out_ / "report.json");
  EXPECT_TRUE(report["warnings"].empty()) << report["warnings"];
  for (const char* measure :
       {"contradicted_percent", "residual_misfit_percent", "plane_thickness_m"}) {
    EXPECT_TRUE(report["consistency"].contains(measure)) << measure;
  }
  EXPECT_THAT(page(), HasSubstr("Consistency, without ground truth"));
}

TEST_F(ReportPage, DoesWithoutTruth) {
  std::filesystem::remove(sequence_ / "groundtruth.txt");
  std::filesystem::remove_all(sequence_ / "range_truth");
  ASSERT_EQ(run("map").status, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("The truth is not known."), Not(HasSubstr("ATE, m")),
                    Not(HasSubstr("Errors over time")), Not(HasSubstr("wraps against the truth"))));
  ASSERT_EQ(run("evaluate", {"--set", "evaluation.methods=none joint"}).status, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("The true path is not known."), Not(HasSubstr("Errors over time"))));
}

TEST_F(ReportPage, OfADeviceShowsItsFrames) {
  const Finished finished = run_program({"map", "tofmap://" + sequence_.string() + "?speed=-1",
                                         "--out", out_.string(), "--set", "report.frames=3"});
  ASSERT_EQ(finished.status, 0) << finished.err;
  EXPECT_THAT(page(), AllOf(HasSubstr("of 4 frames are in this map"),
                            HasSubstr("the same path, ranges as measured")));
  EXPECT_EQ(frames_in(page()), 3);
}

TEST_F(ReportPage, OfAnEvaluationComparesWithAndWithout) {
  ASSERT_EQ(run("evaluate", {"--set", "evaluation.methods=joint none"}).status, 0);
  EXPECT_THAT(page(),
              AllOf(HasSubstr("With unwrapping (joint) the map is"),
                    HasSubstr("; without it, the map is"), HasSubstr("path error over time"),
                    HasSubstr("wrong wraps over range"), HasSubstr("<td>none</td>")));
}

TEST_F(ReportPage, OfRangesAloneIsJudgedByTheirWraps) {
  const auto verdict_on_page_of = [&](const std::string& method) {
    EXPECT_EQ(run("evaluate", {"--set", "evaluation.methods=" + method, "--set",
                               "evaluation.down_to=unwrapping"})
                  .status,
              0);
    return page();
  };
  EXPECT_THAT(verdict_on_page_of("none"), HasSubstr("Do not trust this result."));
  EXPECT_THAT(verdict_on_page_of("joint"), HasSubstr("Looks right."));
}

TEST_F(ReportPage, OfRangesAloneHasNoMap) {
  ASSERT_EQ(run("evaluate", {"--set", "evaluation.methods=pixel none", "--set",
                             "evaluation.down_to=unwrapping"})
                .status,
            0);
  EXPECT_THAT(page(), AllOf(HasSubstr("With unwrapping (pixel)"),
                            HasSubstr("ranges are off by more than half a wavelength"),
                            Not(HasSubstr("The map from above")),
                            Not(HasSubstr("The true path is not known"))));
}

}  // namespace
}  // namespace tofmap::test
