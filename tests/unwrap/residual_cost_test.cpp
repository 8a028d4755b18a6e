// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "errors/median.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>
#include <tofmap/unwrap/common/residual_cost.hpp>

namespace tofmap {
namespace {

/// A frame of random phases and amplitudes, some without a return. As wide as no vector is.
struct RandomFrame {
  SensorModel sensor;
  Frame frame = blank_frame(2);

  explicit RandomFrame(double max_range_m) {
    sensor.modulation = {29e6, 31e6};
    sensor.max_range_m = max_range_m;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> phase(0, 1);
    std::uniform_real_distribution<float> amplitude(5, 500);
    for (ImageF* image :
         {&frame.phases[0], &frame.phases[1], &frame.amplitudes[0], &frame.amplitudes[1]}) {
      image->resize(37, 53);
    }
    for (Eigen::Index i = 0; i < frame.phases[0].size(); ++i) {
      frame.phases[0].data()[i] = phase(random);
      frame.phases[1].data()[i] = i % 17 == 0 ? NAN : phase(random);
      frame.amplitudes[0].data()[i] = amplitude(random);
      frame.amplitudes[1].data()[i] = amplitude(random);
    }
  }
};

class Beat : public testing::TestWithParam<double> {};

TEST_P(Beat, NearestPairHasTheLeastResidualOfAllCounts) {
  const RandomFrame random(GetParam());
  const PairLimits limits = unwrap_limits(random.sensor, 0).pair(0, 1);
  const ImageU8 nearest = nearest_pair_counts(random.frame, limits);
  for (Eigen::Index i = 0; i < nearest.size(); ++i) {
    const float a = random.frame.phases[0].data()[i];
    const float b = random.frame.phases[1].data()[i];
    const int found = nearest.data()[i];
    ASSERT_EQ(std::isnan(b), found == invalid_wrap_count);
    if (std::isnan(b)) continue;
    ASSERT_TRUE(count_within_limits(limits, a, found));
    for (int n = 0; n < limits.count_a && count_within_limits(limits, a, n); ++n) {
      constexpr float rounding_m = 1e-4F;  // of ranges up to 70 m
      ASSERT_LE(std::abs(count_residual_m(limits, a, b, found)),
                std::abs(count_residual_m(limits, a, b, n)) + rounding_m);
    }
  }
}

/// The definition, for one pixel and any count.
float plain_cost(const RandomFrame& random, const PairLimits& limits,
                 const std::vector<PhaseNoise>& noise, Eigen::Index i, int n) {
  const float a = random.frame.phases[0].data()[i];
  const float b = random.frame.phases[1].data()[i];
  if (std::isnan(b) || n < 0 || !count_within_limits(limits, a, n)) return ResidualCost::bound;
  const double sigma_a_m =
      noise[0].scale / random.frame.amplitudes[0].data()[i] * limits.wavelength_a_m;
  const double sigma_b_m =
      noise[1].scale / random.frame.amplitudes[1].data()[i] * limits.wavelength_b_m;
  const double residual_m = count_residual_m(limits, a, b, n);
  const double variance_m2 = sigma_a_m * sigma_a_m + sigma_b_m * sigma_b_m;
  return std::min(static_cast<float>(residual_m * residual_m / (2 * variance_m2)),
                  ResidualCost::bound);
}

TEST_P(Beat, CostIsThatOfTheDefinition) {
  const RandomFrame random(GetParam());
  const PairLimits limits = unwrap_limits(random.sensor, 0).pair(0, 1);
  const std::vector<PhaseNoise> noise{{1}, {1}};
  const ResidualCost cost(random.frame, limits, PhaseSigma(random.frame, noise));
  const auto counts = static_cast<int>(cost.size());
  constexpr float tolerance = 2e-2F;  // 1e-4 m of a residual of up to 0.15 m at a noise of 1 cm
  for (Eigen::Index i = 0; i < random.frame.phases[0].size(); i += 5) {
    for (int n = -2; n <= limits.count_a + 1; ++n) {
      ASSERT_NEAR(cost(i, n), plain_cost(random, limits, noise, i, n), tolerance) << n;
    }
    for (const int offset : {0, 1, -2, limits.count_a, -counts, counts}) {
      const std::array<CountedPixel, 2> twice{
          {{static_cast<int>(i), offset}, {static_cast<int>(i), 0}}};
      std::vector<float> sums(cost.size(), 1);
      cost.add(twice, sums);
      for (int k = 0; k < counts; ++k) {
        ASSERT_FLOAT_EQ(sums[static_cast<std::size_t>(k)],
                        1 + cost(i, k - 1 + offset) + cost(i, k - 1))
            << offset << " " << k;
      }
    }
  }
}

TEST_P(Beat, ProbabilityIsTheShareOfTheLikelihood) {
  const RandomFrame random(GetParam());
  const PairLimits limits = unwrap_limits(random.sensor, 0).pair(0, 1);
  const ResidualCost cost(random.frame, limits, PhaseSigma(random.frame, {{1}, {1}}));
  const ImageU8 counts = nearest_pair_counts(random.frame, limits);
  const ImageF probability = cost.probability(counts);
  for (Eigen::Index i = 0; i < counts.size(); ++i) {
    double sum = 0;
    for (int n = 0; n < limits.count_a; ++n) sum += std::exp(-cost(i, n));
    const bool is_valid = counts.data()[i] != invalid_wrap_count;
    ASSERT_NEAR(probability.data()[i], is_valid ? std::exp(-cost(i, counts.data()[i])) / sum : 0,
                1e-5);
  }
}

INSTANTIATE_TEST_SUITE_P(Ranges, Beat, testing::Values(4.0, 20.0, 72.0));

TEST(MedianOfPositive, IsThatOfSorting) {
  std::mt19937 random(5);
  std::lognormal_distribution<float> spread(0, 6);
  for (std::size_t size = 1; size < 300; size += 7) {
    std::vector<float> values;
    for (std::size_t i = 0; i < size; ++i) values.push_back(i % 5 == 0 ? 0 : spread(random));
    const float median = median_of_positive(values);
    std::sort(values.begin(), values.end());
    EXPECT_EQ(median, values[size / 2]) << size;
  }
}

}  // namespace
}  // namespace tofmap
