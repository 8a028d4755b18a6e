// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

TEST(Median, IsTheMiddleOne) {
  std::vector<double> odd{7, -3, 100, 1, 5};
  EXPECT_EQ(median(odd), 5);
  std::vector<float> one{2.5F};
  EXPECT_EQ(median(one), 2.5F);
}

TEST(Median, OfAnEvenNumberIsTheUpperOne) {
  std::vector<int> even{4, 1, 3, 2};
  EXPECT_EQ(median(even), 3);
}

}  // namespace
}  // namespace tofmap
