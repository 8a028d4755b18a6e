// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "correction_system.hpp"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {
namespace {

/// Draws what is known of poses.
class Draw {
 public:
  Eigen::VectorXd numbers(int count) {
    return Eigen::VectorXd::NullaryExpr(count, [&] { return normal_(random_); });
  }

  RelativeTerm term(int keyframe) {
    RelativeTerm term{.keyframe = keyframe};
    const Eigen::Matrix<double, 6, 6> root = numbers(36).reshaped(6, 6);
    term.information = information * root * root.transpose();
    term.gradient = information * numbers(6);
    term.twist_by_keyframe = twist_at_offset(numbers(3));
    return term;
  }

 private:
  static constexpr double information = 1e6;  // far more than that of the prior, which is 1

  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

std::vector<bool> first_held(int keyframes) {
  std::vector<bool> is_held(static_cast<std::size_t>(keyframes), false);
  is_held.front() = true;
  return is_held;
}

TEST(CorrectionSystem, EliminatesFramesWithoutChangingTheSolution) {
  // Each frame is known relative to three of four keyframes: eliminated in one system, and a
  // keyframe of its own in the other.
  constexpr int keyframes = 4;
  constexpr int frames = 5;
  Draw draw;
  CorrectionSystem eliminated(first_held(keyframes));
  CorrectionSystem whole(first_held(keyframes + frames));
  std::vector<std::vector<RelativeTerm>> terms;
  for (int frame = 0; frame < frames; ++frame) {
    terms.emplace_back();
    for (int i = 0; i < 3; ++i) {
      terms.back().push_back(draw.term((frame + i) % keyframes));
      whole.add(keyframes + frame, terms.back().back());
    }
    eliminated.add_frame(terms.back(), FrameEquations(terms.back()));
  }
  const auto found = eliminated.solve();
  const auto expected = whole.solve();
  ASSERT_TRUE(found && expected);
  constexpr double rounding = 1e-4;  // and the prior, which frames have in one system only
  EXPECT_LT((*found - expected->head(6 * keyframes)).norm(), rounding * expected->norm());
  for (int frame = 0; frame < frames; ++frame) {
    const auto& of_frame = terms[static_cast<std::size_t>(frame)];
    EXPECT_LT((frame_correction(of_frame, FrameEquations(of_frame), *found) -
               expected->segment<6>(6 * (keyframes + frame)))
                  .norm(),
              rounding * expected->norm())
        << frame;
  }
}

TEST(CorrectionSystem, FindsTheMinimumOfTheCost) {
  // One keyframe relative to one that is held: A e + g = 0.
  Draw draw;
  const RelativeTerm term = draw.term(0);
  CorrectionSystem system(first_held(2));
  system.add(1, term);
  const auto found = system.solve();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->head<6>().norm(), 0);
  // But for the prior of each correction, with a standard deviation of 1.
  EXPECT_LT((term.information * found->tail<6>() + found->tail<6>() + term.gradient).norm(), 1e-3);
}

TEST(CorrectionSystem, PutsPosesWhereTheMotionIsSteady) {
  // The first pose is held, the second is known to be at e₁, and the motion puts the third at
  // (1 + share) e₁ − change.
  CorrectionSystem system(first_held(3));
  RelativeTerm term{.keyframe = 0};
  term.information = 1e9 * Eigen::Matrix<double, 6, 6>::Identity();
  term.gradient << 1e7, 2e7, 3e7, -1e7, -2e7, -3e7;
  system.add(1, term);
  MotionTerm motion{.share = 0.5};
  motion.change << 0.1, 0, -0.1, 0.2, 0, 0;
  motion.sigmas.setConstant(1e-3);
  system.add_motion({0, 1, 2}, motion);
  const auto found = system.solve();
  ASSERT_TRUE(found);
  const Eigen::Matrix<double, 6, 1> second = -term.gradient / 1e9;
  EXPECT_LT((found->segment<6>(6) - second).norm(), 1e-6);
  EXPECT_LT((found->tail<6>() - 1.5 * second + motion.change).norm(), 1e-4);
}

TEST(CorrectionSystem, LeavesKeyframesWhereTheyAreThatNothingDetermines) {
  // Keyframes 2 and 3 are known relative to each other alone.
  Draw draw;
  CorrectionSystem system(first_held(4));
  system.add(1, draw.term(0));
  RelativeTerm term = draw.term(2);
  term.gradient.setZero();
  system.add(3, term);
  const auto found = system.solve();
  ASSERT_TRUE(found);
  EXPECT_GT(found->segment<6>(6).norm(), 0.01);
  EXPECT_LT(found->tail<12>().norm(), 1e-9);
}

TEST(CorrectionSystem, HasNoSolutionWithNumbersThatAreTooLarge) {
  Draw draw;
  CorrectionSystem system(first_held(2));
  RelativeTerm term = draw.term(0);
  term.information *= 1e300;
  term.twist_by_keyframe *= 1e300;
  term.gradient *= 1e300;
  system.add(1, term);
  system.add(1, term);
  term.keyframe = 1;
  system.add(0, term);
  EXPECT_FALSE(system.solve());
}

TEST(CorrectionSystem, MovesNothingIfAllIsHeld) {
  Draw draw;
  CorrectionSystem system({true, true});
  system.add(1, draw.term(0));
  EXPECT_EQ(system.solve(), Eigen::VectorXd(Eigen::VectorXd::Zero(12)));
}

TEST(CorrectionSystem, TellsWhetherTermsDetermineAFrame) {
  Draw draw;
  RelativeTerm term = draw.term(0);
  EXPECT_TRUE(FrameEquations({&term, 1}).are_regular());
  term.information.row(2).setZero();
  term.information.col(2).setZero();
  EXPECT_FALSE(FrameEquations({&term, 1}).are_regular());
}

}  // namespace
}  // namespace tofmap
