// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "exact_enumeration.hpp"
#include "plain_jump_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/unwrap/jump/jump_propagation.hpp>

namespace tofmap {
namespace {

JumpProbabilities empty_nodes(Eigen::Index rows, Eigen::Index cols) {
  JumpProbabilities nodes;
  for (ImageF& plane : nodes.x) plane = ImageF::Zero(rows, cols - 1);
  for (ImageF& plane : nodes.y) plane = ImageF::Zero(rows - 1, cols);
  return nodes;
}

JumpProbabilities random_evidence(Eigen::Index rows, Eigen::Index cols, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> weight(0.05F, 1);
  JumpProbabilities nodes = empty_nodes(rows, cols);
  for (auto* group : {&nodes.x, &nodes.y}) {
    for (Eigen::Index i = 0; i < (*group)[0].size(); ++i) {
      const std::array<float, 3> w{weight(random), weight(random), weight(random)};
      const float sum = w[0] + w[1] + w[2];
      for (std::size_t c = 0; c < 3; ++c) (*group)[c].data()[i] = w[c] / sum;
    }
  }
  return nodes;
}

float largest_difference(const JumpProbabilities& a, const JumpProbabilities& b) {
  float largest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    if (a.x[c].size() > 0) largest = std::max(largest, (a.x[c] - b.x[c]).abs().maxCoeff());
    if (a.y[c].size() > 0) largest = std::max(largest, (a.y[c] - b.y[c]).abs().maxCoeff());
  }
  return largest;
}

struct Size {
  Eigen::Index rows;
  Eigen::Index cols;
};

constexpr std::array schedules{MessageSchedule::one_by_one, MessageSchedule::together};

class TreeOfCurls : public testing::TestWithParam<Size> {};

TEST_P(TreeOfCurls, HasTheMarginalsOfExactEnumeration) {
  const auto [rows, cols] = GetParam();
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const JumpProbabilities evidence = random_evidence(rows, cols, seed);
    const test::ExactMarginals exact(evidence);
    for (const MessageSchedule schedule : schedules) {
      // On a tree two iterations carry every message; more change nothing.
      const JumpBeliefs beliefs = propagate_jump_beliefs(evidence, 4, 4, schedule);
      EXPECT_LT(largest_difference(beliefs.marginals, exact.marginals()), 1e-6F) << "seed " << seed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Chains, TreeOfCurls,
                         testing::Values(Size{2, 2}, Size{2, 3}, Size{3, 2}, Size{2, 4},
                                         Size{4, 2}));

TEST(PrintedSchedule, SendsForwardBackwardUpAndDown) {
  for (const auto& [rows, cols] : {Size{2, 2}, {3, 5}, {7, 4}, {20, 35}}) {
    const JumpProbabilities evidence = random_evidence(rows, cols, 3);
    test::PlainJumpPropagation plain(evidence);
    JumpPropagation kept;  // with the messages of the run before, which must not matter
    for (int iterations = 1; iterations <= 3; ++iterations) {
      plain.iterate();
      JumpBeliefs beliefs;
      kept.run(evidence, iterations, beliefs, iterations, MessageSchedule::one_by_one);
      EXPECT_LT(largest_difference(beliefs.marginals, plain.marginals()), 1e-5F)
          << rows << " x " << cols << ", " << iterations;
      EXPECT_EQ(beliefs.curl_violations,
                count_curl_violations(most_likely_configurations(beliefs.marginals)));
    }
  }
}

TEST(PrintedSchedule, IsNoOtherThanTheSweepsTogetherOnceMessagesSettle) {
  const JumpProbabilities evidence = random_evidence(6, 9, 5);
  const JumpBeliefs one_by_one =
      propagate_jump_beliefs(evidence, 500, 500, MessageSchedule::one_by_one);
  const JumpBeliefs together =
      propagate_jump_beliefs(evidence, 500, 500, MessageSchedule::together);
  EXPECT_LT(one_by_one.largest_message_change, 1e-5);
  EXPECT_LT(largest_difference(one_by_one.marginals, together.marginals), 1e-4F);
}

/// Evidence that favours the jumps of a field of counts, and is misleading at one node.
JumpProbabilities evidence_of_field(const Image<int>& count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> weight(0.02F, 0.2F);
  JumpProbabilities nodes = random_evidence(count.rows(), count.cols(), seed);
  const auto favour = [&](std::array<ImageF, 3>& planes, Eigen::Index v, Eigen::Index u, int jump) {
    float sum = 0;
    for (int c = 0; c < 3; ++c) {
      planes[static_cast<std::size_t>(c)](v, u) = c - 1 == jump ? 1 : weight(random);
      sum += planes[static_cast<std::size_t>(c)](v, u);
    }
    for (ImageF& plane : planes) plane(v, u) /= sum;
  };
  for (Eigen::Index v = 0; v < count.rows(); ++v) {
    for (Eigen::Index u = 0; u + 1 < count.cols(); ++u) {
      favour(nodes.x, v, u, count(v, u) - count(v, u + 1));
    }
  }
  for (Eigen::Index v = 0; v + 1 < count.rows(); ++v) {
    for (Eigen::Index u = 0; u < count.cols(); ++u) {
      favour(nodes.y, v, u, count(v, u) - count(v + 1, u));
    }
  }
  return nodes;
}

TEST(SmallLoopyGrid, FindsTheConsistentConfigurationAgainstOneMisleadingNode) {
  Image<int> count(3, 3);
  count << 0, 0, 1, 0, 1, 1, 0, 1, 1;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    JumpProbabilities evidence = evidence_of_field(count, seed);
    // The jump between (0, 1) and (0, 2) looks as likely as none.
    evidence.x[0](0, 1) = 0.4F;
    evidence.x[1](0, 1) = 0.5F;
    evidence.x[2](0, 1) = 0.1F;
    for (const MessageSchedule schedule : schedules) {
      const JumpBeliefs beliefs = propagate_jump_beliefs(evidence, 20, 1, schedule);
      EXPECT_TRUE(beliefs.converged) << "seed " << seed;
      const JumpConfigurations found = most_likely_configurations(beliefs.marginals);
      EXPECT_EQ(count_curl_violations(found), 0);
      for (Eigen::Index v = 0; v < 3; ++v) {
        for (Eigen::Index u = 0; u < 2; ++u) {
          EXPECT_EQ(found.x(v, u), count(v, u) - count(v, u + 1)) << "seed " << seed;
          EXPECT_EQ(found.y(u, v), count(u, v) - count(u + 1, v)) << "seed " << seed;
        }
      }
    }
  }
}

TEST(SmallLoopyGrid, KeepsContradictoryBeliefsFinite) {
  // Nodes as sure as evidence can be, that cannot all be right: messages meet head on.
  JumpProbabilities evidence = empty_nodes(6, 6);
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> configuration(0, 2);
  for (auto* group : {&evidence.x, &evidence.y}) {
    for (ImageF& plane : *group) plane.setConstant(1e-6F);
    for (Eigen::Index i = 0; i < (*group)[0].size(); ++i) {
      (*group)[configuration(random)].data()[i] = 1;
    }
  }
  for (const MessageSchedule schedule : schedules) {
    const JumpBeliefs beliefs = propagate_jump_beliefs(evidence, 200, 1, schedule);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_TRUE(beliefs.marginals.x[c].isFinite().all());
      EXPECT_TRUE(beliefs.marginals.y[c].isFinite().all());
    }
  }
}

TEST(CurlCount, SeesASingleJumpThatLeadsNowhere) {
  JumpConfigurations jumps;
  jumps.x = Image<std::int8_t>::Zero(3, 2);
  jumps.y = Image<std::int8_t>::Zero(2, 3);
  EXPECT_EQ(count_curl_violations(jumps), 0);
  jumps.x(1, 0) = -1;  // between two curls
  EXPECT_EQ(count_curl_violations(jumps), 2);
  jumps.x(1, 0) = absent_jump;  // both curls lose a node, and do not count
  EXPECT_EQ(count_curl_violations(jumps), 0);
}

JumpProbabilities discontinuity_alone(const ImageF& phase, const ImageF& noise_cycles,
                                      double sigma_cycles) {
  JumpProbabilities f_d;
  find_jump_evidence(phase, noise_cycles, {},
                     {.sigma_cycles = sigma_cycles,
                      .window_px = 1,
                      .trust_discontinuity = 1,
                      .trust_frequency = 0},
                     f_d);
  return f_d;
}

TEST(DiscontinuityTerm, IsEquationOne) {
  ImageF phase(1, 2);
  phase << 0.9F, 0.3F;
  const JumpProbabilities f_d = discontinuity_alone(phase, ImageF::Zero(1, 2), 0.25);
  // exp(−(0.3 − 0.9 − i)² / (2 · 0.25²)) for i = −1, 0, 1 is 0.278037, 0.056135, 1.3e-9
  EXPECT_NEAR(f_d.x[0](0, 0), 0.832018F, 1e-5F);
  EXPECT_NEAR(f_d.x[1](0, 0), 0.167982F, 1e-5F);
  EXPECT_NEAR(f_d.x[2](0, 0), 1e-6F / 0.334172F, 1e-8F);  // the least that is given
}

TEST(DiscontinuityTerm, BelievesNoisyPhasesLess) {
  ImageF phase(1, 2);
  phase << 0.9F, 0.1F;
  ImageF noise(1, 2);
  noise << 0.12F, 0.16F;
  // 0.15² + 0.12² + 0.16² = 0.25²
  const JumpProbabilities noisy = discontinuity_alone(phase, noise, 0.15);
  const JumpProbabilities wide = discontinuity_alone(phase, ImageF::Zero(1, 2), 0.25);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(noisy.x[c](0, 0), wide.x[c](0, 0), 1e-6F);
}

TEST(FrequencyTerm, IsEquationThree) {
  ImageF phase(1, 2);
  phase << 0.9F, 0.1F;
  ImageF reconstruction(1, 2);
  reconstruction << 0.9F, 1.1F;  // |0.9 − 0.9| − |1.1 − 0.1| = −1: a wrap between them
  const JumpTerms terms{
      .sigma_cycles = 0.5, .window_px = 1, .trust_discontinuity = 0, .trust_frequency = 1};
  JumpProbabilities f_f;
  find_jump_evidence(phase, ImageF::Zero(1, 2), reconstruction, terms, f_f);
  // exp(0), exp(−1 / (2 · 0.5²)) and exp(−4 / (2 · 0.5²)), normalised
  const float sum = 1 + 0.135335F + 0.000335F;
  EXPECT_NEAR(f_f.x[0](0, 0), 1 / sum, 1e-5F);
  EXPECT_NEAR(f_f.x[1](0, 0), 0.135335F / sum, 1e-5F);
  EXPECT_NEAR(f_f.x[2](0, 0), 0.000335F / sum, 1e-5F);
  EXPECT_EQ(f_f.y[0].size(), 0);
}

TEST(JumpEvidence, IsTheProductOfBothTermsAsFarAsTheyAreTrusted) {
  ImageF phase(3, 1);
  phase << 0.9F, 0.3F, NAN;
  ImageF reconstruction(3, 1);
  reconstruction << 0.9F, 1.3F, NAN;
  const auto evidence = [&](double c_d, double c_f) {
    JumpProbabilities out;
    find_jump_evidence(
        phase, ImageF::Zero(3, 1), reconstruction,
        {.sigma_cycles = 0.5, .window_px = 1, .trust_discontinuity = c_d, .trust_frequency = c_f},
        out);
    return out;
  };
  const JumpProbabilities both = evidence(0.9, 0.5);
  const auto gaussian = [](double difference, int configuration) {
    return std::exp(-std::pow(difference - configuration, 2) / (2 * 0.5 * 0.5));
  };
  double sum = 0;
  std::array<double, 3> product{};
  for (int i = -1; i <= 1; ++i) {
    const auto k = static_cast<std::size_t>(i + 1);
    product[k] = (0.1 + 0.9 * gaussian(-0.6, i)) * (0.5 + 0.5 * gaussian(-1, i));
    sum += product[k];
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(both.y[k](0, 0), product[k] / sum, 1e-5);
    EXPECT_TRUE(std::isnan(both.y[k](1, 0))) << "the lower pixel has no return";
    EXPECT_NEAR(evidence(0, 0).y[k](0, 0), 1.0 / 3, 1e-6) << "nothing is trusted";
  }
}

TEST(SideMedians, AreCutShortAtBordersAndPassOverMissingPixels) {
  ImageF image(1, 5);
  image << 1, 5, NAN, 2, 3;
  const SideMedians medians = side_medians_x(image, 3);
  EXPECT_FLOAT_EQ(medians.neg(0, 0), 1);  // {1}
  EXPECT_FLOAT_EQ(medians.pos(0, 0), 2);  // {5, NaN, 2}: the lower middle
  EXPECT_FLOAT_EQ(medians.neg(0, 3), 2);  // {NaN, 2} and 5
  EXPECT_FLOAT_EQ(medians.pos(0, 3), 3);  // {3}
}

TEST(SideMedians, AreThoseOfEachWindowByItself) {
  ImageF image(21, 70);
  std::mt19937 random(2);
  std::uniform_real_distribution<float> value(-1, 3);
  for (float& v : image.reshaped()) v = value(random) > 2.5F ? NAN : value(random);
  const auto median = [&](Eigen::Index row, Eigen::Index col, Eigen::Index rows,
                          Eigen::Index cols) {
    std::vector<float> window;
    for (Eigen::Index v = std::max<Eigen::Index>(row, 0); v < std::min(row + rows, image.rows());
         ++v) {
      for (Eigen::Index u = std::max<Eigen::Index>(col, 0); u < std::min(col + cols, image.cols());
           ++u) {
        if (!std::isnan(image(v, u))) window.push_back(image(v, u));
      }
    }
    std::sort(window.begin(), window.end());
    return window.empty() ? NAN : window[(window.size() - 1) / 2];
  };
  const auto expect_same = [](float found, float expected) {
    if (std::isnan(expected)) {
      ASSERT_TRUE(std::isnan(found));
    } else {
      ASSERT_EQ(found, expected);
    }
  };
  for (const int k : {1, 2, 5, 8, 25}) {
    const SideMedians x = side_medians_x(image, k);
    const SideMedians y = side_medians_y(image, k);
    for (Eigen::Index v = 0; v + 1 < image.rows(); ++v) {
      for (Eigen::Index u = 0; u + 1 < image.cols(); ++u) {
        expect_same(x.neg(v, u), median(v, u - k + 1, 1, k));
        expect_same(x.pos(v, u), median(v, u + 1, 1, k));
        expect_same(y.neg(v, u), median(v - k + 1, u, k, 1));
        expect_same(y.pos(v, u), median(v + 1, u, k, 1));
      }
    }
  }
}

}  // namespace
}  // namespace tofmap
