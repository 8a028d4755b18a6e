// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/verdict.hpp"

#include <gtest/gtest.h>

namespace tofmap {
namespace {

// Scripts that read report.json depend on the names.
TEST(Verdict, HasANameAndASentence) {
  EXPECT_EQ(name_of(Verdict::good), "good");
  EXPECT_EQ(name_of(Verdict::check), "check");
  EXPECT_EQ(name_of(Verdict::bad), "bad");
  EXPECT_EQ(sentence_of(Verdict::good), "Looks right.");
  EXPECT_EQ(sentence_of(Verdict::check), "Check this result.");
  EXPECT_EQ(sentence_of(Verdict::bad), "Do not trust this result.");
}

TEST(Verdict, IsOrderedFromGoodToBad) {
  EXPECT_LT(Verdict::good, Verdict::check);
  EXPECT_LT(Verdict::check, Verdict::bad);
}

}  // namespace
}  // namespace tofmap
