// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include <optional>

#include <gtest/gtest.h>

#include <tofmap/mapping/join_evidence.hpp>

namespace tofmap {
namespace {

JoinEvidence evidence(int differing, int agreeing) {
  JoinEvidence evidence;
  for (int i = 0; i < differing; ++i) evidence.add(true);
  for (int i = 0; i < agreeing; ++i) evidence.add(false);
  evidence.add(std::nullopt);
  return evidence;
}

TEST(JoinEvidence, CountsKeyframesThatSeeTheSame) {
  EXPECT_EQ(evidence(2, 3).compared, 5);
  EXPECT_EQ(evidence(2, 3).differing, 2);
}

TEST(JoinEvidence, RefutesAJoinByTwoKeyframes) {
  EXPECT_FALSE(evidence(0, 0).refutes(false));
  EXPECT_FALSE(evidence(1, 0).refutes(false));
  EXPECT_TRUE(evidence(2, 10).refutes(false));
}

TEST(JoinEvidence, RefutesAJoinWithAnEarlierRecordingByMostKeyframes) {
  EXPECT_FALSE(evidence(1, 0).refutes(true));
  EXPECT_FALSE(evidence(2, 2).refutes(true));
  EXPECT_TRUE(evidence(3, 2).refutes(true));
}

}  // namespace
}  // namespace tofmap
