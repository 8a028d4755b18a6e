// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/core/text.hpp"

#include <gtest/gtest.h>

namespace tofmap {
namespace {

const std::string replacement = "\xEF\xBF\xBD";

TEST(ValidUtf8, LeavesValidTextsAsTheyAre) {
  for (const std::string text : {"", "room", "Büro", "房间", "\xF0\x9F\x8F\xA0", "a\nb",
                                 "\xED\x9F\xBF", "\xF4\x8F\xBF\xBF"}) {
    EXPECT_EQ(valid_utf8(text), text);
  }
  const std::string with_nul("a\0b", 3);
  EXPECT_EQ(valid_utf8(with_nul), with_nul);
}

TEST(ValidUtf8, ReplacesEachByteThatIsNone) {
  EXPECT_EQ(valid_utf8("rec\xff"), "rec" + replacement);
  EXPECT_EQ(valid_utf8("B\xfcro"), "B" + replacement + "ro");
  EXPECT_EQ(valid_utf8("\xE6\x88"), replacement + replacement) << "cut short";
  EXPECT_EQ(valid_utf8("\xC0\xAF"), replacement + replacement) << "overlong";
  EXPECT_EQ(valid_utf8("\xE0\x80\xAF"), replacement + replacement + replacement) << "overlong";
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), replacement + replacement + replacement) << "a surrogate";
  EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80").size(), 4 * replacement.size()) << "beyond Unicode";
}

}  // namespace
}  // namespace tofmap
