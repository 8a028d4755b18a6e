// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "reports/evaluation_report.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace tofmap::app {
namespace {

/// A report of two methods, of which one has some separate maps.
nlohmann::ordered_json report_with(int separate_maps) {
  nlohmann::ordered_json report;
  for (const std::string method : {"none", "joint"}) {
    report["unwrapping"][method] = {{"wrong_wrap_percent", 1.0}};
    report["trajectory"][method] = {{"registered_frames", 30},
                                    {"separate_maps", method == "none" ? separate_maps : 0}};
  }
  return report;
}

TEST(EvaluationTable, HasAColumnOfOtherMapsIfThereAreAny) {
  const std::vector<std::vector<std::string>> table = table_of(report_with(4));
  const auto column = std::ranges::find(table[1], "maps") - table[1].begin();
  ASSERT_LT(column, std::ssize(table[1]));
  const auto at = static_cast<std::size_t>(column);
  EXPECT_EQ(table[0][at], "other");
  EXPECT_EQ(table[2][at], "4");
  EXPECT_EQ(table[3][at], "0");
}

TEST(EvaluationTable, HasNoColumnOfOtherMapsIfThereAreNone) {
  const std::vector<std::vector<std::string>> table = table_of(report_with(0));
  EXPECT_FALSE(std::ranges::count(table[1], "maps") > 0);
  EXPECT_EQ(table[1].size(), table[2].size());
}

TEST(EvaluationTable, HasTheVerdictsOfTheMethods) {
  nlohmann::ordered_json report = report_with(0);
  report["judgement"]["joint"]["verdict"] = "check";
  const std::vector<std::vector<std::string>> table = table_of(report);
  const auto column = std::ranges::find(table[0], "verdict") - table[0].begin();
  ASSERT_LT(column, std::ssize(table[0]));
  const auto at = static_cast<std::size_t>(column);
  EXPECT_EQ(table[2][at], "-");
  EXPECT_EQ(table[3][at], "check");
}

}  // namespace
}  // namespace tofmap::app
