// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "jump/region_fits.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/core/range_image.hpp>

namespace tofmap {
namespace {

/// Pixels of one surface, 7 wavelengths away, whose residual is noisy: most of them have the right
/// count, some any other.
Frame noisy_surface(const PairLimits& limits, int pixels, double noise_cycles,
                    std::mt19937& random) {
  std::uniform_real_distribution<double> range_m(7.1 * limits.wavelength_a_m,
                                                 7.9 * limits.wavelength_a_m);
  std::normal_distribution<double> noise(0, 1);
  Frame frame = blank_frame(2);
  for (ImageF* image :
       {&frame.phases[0], &frame.phases[1], &frame.amplitudes[0], &frame.amplitudes[1]}) {
    *image = ImageF::Ones(1, pixels);
  }
  const auto fraction = [](double x) { return static_cast<float>(x - std::floor(x)); };
  for (int i = 0; i < pixels; ++i) {
    const double r = range_m(random);
    frame.phases[0](0, i) = fraction(r / limits.wavelength_a_m + noise_cycles * noise(random));
    frame.phases[1](0, i) = fraction(r / limits.wavelength_b_m + noise_cycles * noise(random));
  }
  return frame;
}

/// Costs of counts of a region's root, of all pixels added up.
class PlainFits {
 public:
  PlainFits(const ResidualCost& cost, OffsetUnion& forest) : cost_(cost), forest_(forest) {}

  double of(int root, int count) const {
    double sum = 0;
    for (int i = 0; i < pixels; ++i) {
      const OffsetUnion::Place place = forest_.find(i);
      if (place.root == root) sum += cost_(i, count + place.offset);
    }
    return sum;
  }

  double least(int root) const {
    return least_of([&](int count) { return of(root, count); });
  }

  double least_together(int root, int other, int offset) const {
    return least_of([&](int count) { return of(root, count) + of(other, count + offset); });
  }

  static constexpr int pixels = 150;

 private:
  template <class Cost>
  double least_of(const Cost& cost) const {
    const auto reach = static_cast<int>(cost_.size());
    double least = cost(-1);
    for (int n = 0; n < reach - 1; ++n) least = std::min(least, cost(n));
    return least;
  }

  const ResidualCost& cost_;
  OffsetUnion& forest_;
};

PairLimits all_ranges() {
  SensorModel sensor;
  sensor.modulation = {29e6, 31e6};
  return unwrap_limits(sensor, 0).pair(0, 1);
}

/// Regions of the pixels of a noisy surface, each by itself at first.
struct Pixels {
  Pixels(double noise_cycles, std::mt19937& random)
      : limits(all_ranges()),
        frame(noisy_surface(limits, PlainFits::pixels, noise_cycles, random)),
        cost(frame, limits, PhaseSigma(frame, {{noise_cycles}, {noise_cycles}})),
        forest(PlainFits::pixels),
        fits(cost, nearest_pair_counts(frame, limits), forest),
        plain(cost, forest) {}

  PairLimits limits;
  Frame frame = blank_frame(2);
  ResidualCost cost;
  OffsetUnion forest;
  RegionFits fits;
  PlainFits plain;
};

TEST(RegionFits, DecideAsIfAllCostsWereSummed) {
  constexpr double objection_share = 1;
  int joined = 0;
  int refused = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    std::mt19937 random(seed);
    Pixels pixels(0.02, random);
    auto& [limits, frame, cost, forest, fits, plain] = pixels;
    std::uniform_int_distribution<int> pixel(0, PlainFits::pixels - 1);
    std::discrete_distribution<int> wrong_step({0.2, 0.6, 0.2});
    std::uniform_real_distribution<float> certainty(0.6F, 1.0F);
    for (int trial = 0; trial < 3000; ++trial) {
      // Pixels of the same fifteen find each other first, so that large regions meet later.
      const int first = pixel(random);
      const int second = pixel(random);
      if (trial < 2000 && first / 15 != second / 15) continue;
      const OffsetUnion::Place p = forest.find(first);
      const OffsetUnion::Place q = forest.find(second);
      if (p.root == q.root) continue;
      const int root = forest.size(p.root) >= forest.size(q.root) ? p.root : q.root;
      const int other = root == p.root ? q.root : p.root;
      const int offset = trial < 2000 ? 0 : wrong_step(random) - 1;
      const float sure = certainty(random);
      const double tolerated = objection_share * std::log(sure / std::max(1 - sure, 1e-6F));
      const double objection =
          plain.least_together(root, other, offset) - plain.least(root) - plain.least(other);
      const bool is_joined = fits.join(root, other, offset, sure, objection_share);
      constexpr double rounding = 1e-2;  // of sums of up to 150 costs of up to 4.5 in float
      if (std::abs(objection - tolerated) > rounding) {
        ASSERT_EQ(is_joined, objection <= tolerated)
            << "seed " << seed << ", trial " << trial << ": " << objection << " " << tolerated;
      }
      (is_joined ? joined : refused) += 1;
      if (!is_joined) continue;
      forest.join(root, other, offset);
      ASSERT_NEAR(plain.of(root, fits.best_count(root)), plain.least(root), rounding);
    }
  }
  EXPECT_GT(joined, 500);
  EXPECT_GT(refused, 400);
}

TEST(RegionFits, OfTwoLargeRegionsBothAreHeard) {
  std::mt19937 random(3);
  Pixels pixels(0.002, random);
  auto& [limits, frame, cost, forest, fits, plain] = pixels;
  constexpr int other = 100;  // the first of fifty pixels
  for (int i = 1; i < PlainFits::pixels; ++i) {
    const int root = i < other ? 0 : other;
    if (i == other) continue;
    ASSERT_TRUE(fits.join(root, i, 0, 0.5F, 1));
    forest.join(root, i, 0);
  }
  // The fifty would have to move by one, which costs far more than a certain bridge may ask for.
  EXPECT_FALSE(fits.join(0, other, 1, 1, 1));
  EXPECT_EQ(fits.best_count(0), 7);
  EXPECT_EQ(fits.best_count(other), 7);
  constexpr double any_objection = 1e6;
  ASSERT_TRUE(fits.join(0, other, 1, 1, any_objection));
  forest.join(0, other, 1);
  EXPECT_EQ(fits.best_count(0), 7) << "the hundred outweigh the fifty";
  EXPECT_NEAR(plain.of(0, 7), plain.least(0), 1e-2);
}

}  // namespace
}  // namespace tofmap
