// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <atomic>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <tofmap/core/side_by_side.hpp>

namespace tofmap::test {
namespace {

TEST(SideBySide, GivesResultsInTheirOrder) {
  const std::vector<int> squares = side_by_side(100, [](int i) { return i * i; });
  ASSERT_EQ(squares.size(), 100);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(squares[static_cast<std::size_t>(i)], i * i);
}

TEST(SideBySide, OfNothingIsNothing) {
  EXPECT_TRUE(side_by_side(0, [](int i) { return i; }).empty());
}

TEST(SideBySide, RunsAllStepsAndRethrowsTheFirstErrorByNumber) {
  std::atomic<int> runs = 0;
  const auto fails_at_3_and_7 = [&](int i) {
    ++runs;
    if (i == 3 || i == 7) throw std::runtime_error(std::to_string(i));
    return i;
  };
  try {
    side_by_side(10, fails_at_3_and_7);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "3");
  }
  EXPECT_EQ(runs, 10);
}

}  // namespace
}  // namespace tofmap::test
