// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/consistency_report.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tofmap::app {
namespace {

TEST(ConsistencyJson, TellsWhatIsNotKnown) {
  Consistency consistency;
  consistency.curl_violations_per_frame = NAN;
  const auto json = consistency_json(consistency);
  EXPECT_TRUE(json["curl_violations_per_frame"].is_null());
  EXPECT_EQ(json["contradicted_percent"], 0);
}

TEST(JudgementJson, HasVerdictReasonsAndRemarks) {
  const auto json = judgement_json(
      {.verdict = Verdict::check, .reasons = {"the map is thin"}, .remarks = {"it rained"}});
  EXPECT_EQ(json["verdict"], "check");
  EXPECT_EQ(json["reasons"][0], "the map is thin");
  EXPECT_EQ(json["remarks"][0], "it rained");
}

}  // namespace
}  // namespace tofmap::app
