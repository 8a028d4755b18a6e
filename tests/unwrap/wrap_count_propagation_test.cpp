// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "common/fast_math.hpp"
#include "plain_wrap_count_propagation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <tofmap/unwrap/joint/wrap_count_model.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {
namespace {

constexpr double noise_cycles = 0.03;

UnwrapLimits limits_up_to(double range_m) {
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  return unwrap_limits(sensor, range_m);
}

/// Two noisy walls, one behind the other, and a few pixels without a return.
Frame noisy_walls(int rows, int cols, const UnwrapLimits& limits, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::normal_distribution<double> normal(0, noise_cycles);
  std::uniform_real_distribution<double> uniform(0, 1);
  const double near_m = 1 + 3 * uniform(random);
  const double far_m = near_m + 0.8 * limits.max_range_m * uniform(random) * 0.7;
  Frame frame = blank_frame(2);
  for (ImageF* image :
       {&frame.phases[0], &frame.phases[1], &frame.amplitudes[0], &frame.amplitudes[1]}) {
    image->resize(rows, cols);
  }
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < cols; ++u) {
      const bool is_far = 2 * u > cols;
      const double range_m = (is_far ? far_m : near_m) + 0.1 * u + 0.03 * v;
      const auto phase = [&](double wavelength_m) {
        const double cycles = range_m / wavelength_m + normal(random);
        return static_cast<float>(cycles - std::floor(cycles));
      };
      frame.phases[0](v, u) = phase(limits.wavelengths_m[0]);
      frame.phases[1](v, u) = phase(limits.wavelengths_m[1]);
      frame.amplitudes[0](v, u) = is_far ? 40.0F : 100.0F;
      frame.amplitudes[1](v, u) = frame.amplitudes[0](v, u);
      if (uniform(random) < 0.05) frame.phases[0](v, u) = frame.phases[1](v, u) = NAN;
    }
  }
  return frame;
}

WrapCountModel model_of(const Frame& frame, const UnwrapLimits& limits) {
  WrapCountModel model;
  model.assign(frame, limits, PhaseSigma(frame, {{noise_cycles * 100}, {noise_cycles * 100}}),
               {0, 0}, {});
  return model;
}

TEST(DiagonalLayout, GivesEveryPixelOfEveryPlaneAPlaceOfItsOwn) {
  for (const auto& [rows, cols] : {std::pair{1, 1}, {1, 7}, {7, 1}, {5, 9}, {9, 5}, {20, 20}}) {
    const DiagonalLayout layout(rows, cols);
    constexpr std::size_t planes = 3;
    std::set<std::size_t> places;
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        for (std::size_t k = 0; k < planes; ++k) {
          places.insert(layout.place(u + v, v, planes) + k * layout.plane_step(u + v));
        }
      }
    }
    EXPECT_EQ(places.size(), planes * static_cast<std::size_t>(rows * cols));
    EXPECT_LT(*places.rbegin(), layout.size(planes));
  }
}

TEST(DiagonalLayout, HasRoomForWhatIsSentOutOfTheImage) {
  const DiagonalLayout layout(6, 4);
  constexpr std::size_t planes = 2;
  std::set<std::size_t> pixels;
  for (int v = 0; v < 6; ++v) {
    for (int u = 0; u < 4; ++u) {
      for (std::size_t k = 0; k < planes; ++k) {
        pixels.insert(layout.place(u + v, v, planes) + k * layout.plane_step(u + v));
      }
    }
  }
  const auto is_outside = [&](int row, int col) {
    const std::size_t last = (planes - 1) * layout.plane_step(row + col);
    const std::size_t place = layout.place(row + col, row, planes);
    return !pixels.contains(place) && !pixels.contains(place + last) &&
           place + last < layout.size(planes);
  };
  for (int v = 0; v < 6; ++v) EXPECT_TRUE(is_outside(v, -1) && is_outside(v, 4)) << v;
  for (int u = 0; u < 4; ++u) EXPECT_TRUE(is_outside(-1, u) && is_outside(6, u)) << u;
}

struct GridSize {
  int rows;
  int cols;
};

class WrapCountPropagationOn : public testing::TestWithParam<GridSize> {};
INSTANTIATE_TEST_SUITE_P(Grids, WrapCountPropagationOn,
                         testing::Values(GridSize{1, 1}, GridSize{1, 9}, GridSize{9, 1},
                                         GridSize{13, 17}, GridSize{40, 11}, GridSize{170, 165}),
                         [](const auto& grid) {
                           return std::to_string(grid.param.rows) + "x" +
                                  std::to_string(grid.param.cols);
                         });

TEST_P(WrapCountPropagationOn, GivesTheBeliefsOfThePlainVersion) {
  const UnwrapLimits limits = limits_up_to(25);
  WrapCountPropagation propagation;
  for (int seed = 0; seed < 3; ++seed) {
    const Frame frame = noisy_walls(GetParam().rows, GetParam().cols, limits, seed);
    const WrapCountModel model = model_of(frame, limits);
    const WrapCountBeliefs fast = propagation.run(model, 3);
    const test::PlainWrapCountModel plain_model(model);
    const auto plain = test::PlainWrapCountPropagation(plain_model).run(3);
    for (std::size_t p = 0; p < plain.size(); ++p) {
      const auto best = std::ranges::max_element(plain[p]);
      // Messages are rounded to 8 binary digits, 0.2 %; a belief is a product of four, and each
      // of them has passed many pixels.
      EXPECT_NEAR(fast.probability.data()[p], *best, 0.05);
      EXPECT_NEAR(plain[p][fast.count.data()[p]], *best, 0.05);
      EXPECT_NEAR(fast.probability.data()[p] + fast.other_probability.data()[p], 1, 1e-5);
    }
  }
}

TEST(WrapCountPropagation, AgreesWithExactEnumerationWhereThatIsSure) {
  const UnwrapLimits limits = limits_up_to(15);
  WrapCountPropagation propagation;
  int sure = 0;
  int agreed = 0;
  for (int seed = 0; seed < 40; ++seed) {
    const Frame frame = noisy_walls(3, 4, limits, seed);
    const WrapCountModel model = model_of(frame, limits);
    const WrapCountBeliefs beliefs = propagation.run(model, 10);
    const auto exact = test::exact_marginals(test::PlainWrapCountModel(model));
    for (std::size_t p = 0; p < exact.size(); ++p) {
      const auto best = std::ranges::max_element(exact[p]);
      if (*best < 0.9) continue;
      ++sure;
      agreed += beliefs.count.data()[p] == best - exact[p].begin() ? 1 : 0;
    }
  }
  EXPECT_GT(sure, 300);
  // Beliefs are an approximation: of 40 grids, one may lean the other way as a whole.
  EXPECT_GT(agreed, 0.97 * sure);
}

TEST(WrapCountPropagation, ForgetsTheFrameBefore) {
  const UnwrapLimits limits = limits_up_to(25);
  const WrapCountModel first = model_of(noisy_walls(30, 20, limits, 1), limits);
  const WrapCountModel second = model_of(noisy_walls(30, 20, limits, 2), limits);
  WrapCountPropagation used;
  used.run(first, 2);
  const WrapCountBeliefs after_another = used.run(second, 2);
  const WrapCountBeliefs fresh = WrapCountPropagation().run(second, 2);
  EXPECT_TRUE((after_another.count == fresh.count).all());
  EXPECT_TRUE((after_another.probability == fresh.probability).all());
}

TEST(WrapCountPropagation, SettlesWithIterations) {
  const UnwrapLimits limits = limits_up_to(25);
  const WrapCountModel model = model_of(noisy_walls(40, 40, limits, 5), limits);
  WrapCountPropagation propagation;
  EXPECT_LT(propagation.run(model, 30).largest_message_change,
            0.5 * propagation.run(model, 2).largest_message_change);
}

TEST(WrapCountModel, KeepsPixelsWithoutAReturnOutOfIt) {
  const UnwrapLimits limits = limits_up_to(25);
  Frame frame = noisy_walls(5, 5, limits, 3);
  frame.phases[0](2, 2) = frame.phases[1](2, 2) = NAN;
  const WrapCountModel model = model_of(frame, limits);
  const DiagonalLayout& layout = model.layout();
  for (const double value : model.evidence_of(2, 2)) EXPECT_EQ(value, 1);
  for (const auto& [v, u] : {std::pair{2, 2}, {2, 1}}) {
    EXPECT_EQ(model.right().same[layout.place(u + v, v, 1)], 0);
    EXPECT_EQ(model.right().next[layout.place(u + v, v, 1)], 0);
  }
  for (const auto& [v, u] : {std::pair{2, 2}, {1, 2}}) {
    EXPECT_EQ(model.down().same[layout.place(u + v, v, 1)], 0);
    EXPECT_EQ(model.down().next[layout.place(u + v, v, 1)], 0);
  }
}

TEST(FastMath, ExponentialIsThatOfTheLibrary) {
  for (double x = 0; x > -86; x -= 0.01) {
    const auto argument = static_cast<float>(x);
    EXPECT_NEAR(exp_of_negative(argument) / std::exp(static_cast<double>(argument)), 1, 1e-5);
  }
  EXPECT_LT(exp_of_negative(-1e9F), 1e-37F);
  EXPECT_EQ(exp_of_negative(0), 1);
}

TEST(FastMath, HalfCycleIsTheDistanceToTheNearestWholeNumber) {
  for (const float x : {-2.7F, -0.6F, -0.4F, 0.0F, 0.4F, 0.6F, 3.2F, 3.9F}) {
    EXPECT_NEAR(to_half_cycle(x), x - std::round(x), 1e-6);
  }
}

TEST(FastMath, BFloat16KeepsEightBinaryDigits) {
  for (float x = 1e-12F; x < 2; x *= 1.37F) EXPECT_NEAR(to_float(to_bfloat16(x)) / x, 1, 1.0 / 256);
  EXPECT_EQ(to_float(bfloat16_one), 1);
}

}  // namespace
}  // namespace tofmap
