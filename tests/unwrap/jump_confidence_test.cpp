// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jump/confidence.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

constexpr int rows = 13;
constexpr int cols = 21;

/// Wrap counts 0 to 3, some of them invalid.
ImageU8 random_counts(std::mt19937& random) {
  std::uniform_int_distribution<int> counts(0, 4);
  ImageU8 image(rows, cols);
  for (std::uint8_t& count : image.reshaped()) {
    const int drawn = counts(random);
    count = drawn == 4 ? invalid_wrap_count : static_cast<std::uint8_t>(drawn);
  }
  return image;
}

/// Normalised probabilities of three configurations; NaN where a node's pixel has no count.
JumpProbabilities random_marginals(const ImageU8& counts, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0.01F, 1);
  JumpProbabilities marginals;
  const auto fill = [&](std::array<ImageF, 3>& planes, int down, int right) {
    for (ImageF& plane : planes) plane.resize(rows - down, cols - right);
    for (int v = 0; v < rows - down; ++v) {
      for (int u = 0; u < cols - right; ++u) {
        const bool is_there =
            counts(v, u) != invalid_wrap_count && counts(v + down, u + right) != invalid_wrap_count;
        float sum = 0;
        for (ImageF& plane : planes) sum += plane(v, u) = is_there ? uniform(random) : NAN;
        for (ImageF& plane : planes) plane(v, u) /= sum;
      }
    }
  };
  fill(marginals.x, 0, 1);
  fill(marginals.y, 1, 0);
  return marginals;
}

/// The definition, pixel by pixel: the mean over the neighbours of the probability of the step
/// there. Configuration i means n(q) − n(p) = −i for q right of p or below it.
float plain_confidence(const ImageU8& counts, const JumpProbabilities& marginals, int v, int u) {
  if (counts(v, u) == invalid_wrap_count) return 0;
  std::vector<float> probabilities;
  const auto add = [&](const std::array<ImageF, 3>& planes, int p_v, int p_u, int q_v, int q_u) {
    if (p_v < 0 || p_u < 0 || q_v >= rows || q_u >= cols) return;
    if (std::isnan(planes[0](p_v, p_u))) return;
    const int i = counts(p_v, p_u) - counts(q_v, q_u);
    probabilities.push_back(std::abs(i) > 1 ? 0
                                            : planes[static_cast<std::size_t>(i + 1)](p_v, p_u));
  };
  add(marginals.x, v, u - 1, v, u);
  add(marginals.x, v, u, v, u + 1);
  add(marginals.y, v - 1, u, v, u);
  add(marginals.y, v, u, v + 1, u);
  if (probabilities.empty()) return 0.5F;
  float sum = 0;
  for (const float probability : probabilities) sum += probability;
  return sum / static_cast<float>(probabilities.size());
}

TEST(JumpConfidence, IsTheMeanProbabilityOfTheStepsToTheNeighbours) {
  std::mt19937 random(8);
  for (int image = 0; image < 10; ++image) {
    const ImageU8 counts = random_counts(random);
    const JumpProbabilities marginals = random_marginals(counts, random);
    const ImageF found = jump_confidence(counts, marginals);
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        EXPECT_NEAR(found(v, u), plain_confidence(counts, marginals, v, u), 1e-6) << v << ", " << u;
      }
    }
  }
}

TEST(JumpConfidence, MultipliesTheOddsOfThePixelsOwnResidual) {
  std::mt19937 random(9);
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  const PairLimits limits = unwrap_limits(sensor, 14).pair(0, 1);
  std::uniform_real_distribution<float> phases(0, 1);
  Frame frame = blank_frame(2);
  frame.phases[0] = ImageF::NullaryExpr(rows, cols, [&] { return phases(random); });
  frame.phases[1] = ImageF::NullaryExpr(rows, cols, [&] { return phases(random); });
  PhaseSigma noise;
  noise.cycles.assign(2, ImageF::Constant(rows, cols, 0.02F));
  const ResidualCost residual(frame, limits, noise);
  ImageU8 counts = nearest_pair_counts(frame, limits);
  counts(3, 3) = invalid_wrap_count;
  const JumpProbabilities marginals = random_marginals(counts, random);
  const ImageF found = jump_and_residual_confidence(counts, marginals, residual);
  const ImageF of_residual = residual.probability(counts);
  EXPECT_EQ(found(3, 3), 0);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      if (counts(v, u) == invalid_wrap_count) continue;
      const double a = plain_confidence(counts, marginals, v, u);
      const double b = of_residual(v, u);
      EXPECT_NEAR(found(v, u), a * b / (a * b + (1 - a) * (1 - b)), 1e-5) << v << ", " << u;
    }
  }
}

}  // namespace
}  // namespace tofmap
