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

}  // namespace
}  // namespace tofmap::app
