// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "joint/block_counts.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <tofmap/unwrap/joint/own_counts.hpp>
#include <tofmap/unwrap/joint/sparse_propagation.hpp>
#include <tofmap/unwrap/joint/wrap_count_model.hpp>
#include <tofmap/unwrap/joint/wrap_count_propagation.hpp>

namespace tofmap {
namespace {

const std::vector<double> kinect_hz{80e6, 16e6, 120e6};

/// With 33 wrap counts.
const std::vector<double> far_hz{99e6, 90e6, 105e6};

UnwrapLimits limits_of(const std::vector<double>& frequencies_hz) {
  SensorModel sensor;
  sensor.modulation.frequencies_hz = frequencies_hz;
  return unwrap_limits(sensor, 0);
}

/// A frame of two walls, the nearer one on the left, and its model.
struct Walls {
  UnwrapLimits limits;
  Frame frame;
  PhaseSigma sigma;
  ImageU8 true_count;
  ImageU8 mixed;

  Walls(const std::vector<double>& frequencies_hz, int rows, int cols, double noise_m,
        unsigned seed, double far_wall_m = 7.3)
      : limits(limits_of(frequencies_hz)),
        frame(blank_frame(frequencies_hz.size())),
        true_count(rows, cols),
        mixed(ImageU8::Zero(rows, cols)) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, noise_m);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (std::size_t f = 0; f < frequencies_hz.size(); ++f) {
      frame.phases[f].resize(rows, cols);
      frame.amplitudes[f] = ImageF::Constant(rows, cols, 100);
      sigma.cycles.push_back(
          ImageF::Constant(rows, cols, static_cast<float>(noise_m / limits.wavelengths_m[f])));
    }
    for (int v = 0; v < rows; ++v) {
      for (int u = 0; u < cols; ++u) {
        const double range_m = (2 * u > cols ? far_wall_m : 3.1) + 0.02 * u + 0.01 * v;
        const bool is_missing = uniform(random) < 0.03;
        for (std::size_t f = 0; f < frequencies_hz.size(); ++f) {
          const double cycles = (range_m + normal(random)) / limits.wavelengths_m[f];
          frame.phases[f](v, u) =
              is_missing ? NAN : static_cast<float>(cycles - std::floor(cycles));
        }
        const double whole = range_m / limits.wavelength_m() - frame.phases[0](v, u);
        true_count(v, u) = static_cast<std::uint8_t>(is_missing ? 0 : std::lround(whole));
      }
    }
  }

  std::vector<double> no_errors_m() const { return std::vector<double>(frame.frequencies(), 0.0); }

  OwnCounts own() const { return find_own_counts(frame, limits, sigma, no_errors_m(), {}, mixed); }

  UncertainPixels uncertain_pixels(const OwnCounts& own_counts) const {
    UncertainPixels pixels;
    pixels.assign(frame, limits, sigma, no_errors_m(), {}, own_counts, mixed, {});
    return pixels;
  }

  WrapCountBeliefs sparse_beliefs(const OwnCounts& own_counts) const {
    return SparsePropagation().run(uncertain_pixels(own_counts), own_counts, 3);
  }

  WrapCountBeliefs dense_beliefs() const {
    WrapCountModel model;
    model.assign(frame, limits, sigma, no_errors_m(), {});
    return WrapCountPropagation().run(model, 3);
  }

  bool has_return(Eigen::Index at) const { return !std::isnan(frame.phases[0].data()[at]); }
};

/// No pixel is certain.
OwnCounts uncertain(Eigen::Index rows, Eigen::Index cols) {
  return {ImageU8::Zero(rows, cols), ImageU8::Zero(rows, cols), ImageF::Ones(rows, cols),
          ImageF::Ones(rows, cols)};
}

struct SparseCase {
  int rows;
  int cols;
};

class SparsePropagationOn : public testing::TestWithParam<SparseCase> {};

INSTANTIATE_TEST_SUITE_P(Grids, SparsePropagationOn,
                         testing::Values(SparseCase{1, 1}, SparseCase{1, 9}, SparseCase{9, 1},
                                         SparseCase{13, 17}, SparseCase{40, 31}),
                         [](const auto& grid) {
                           return std::to_string(grid.param.rows) + "x" +
                                  std::to_string(grid.param.cols);
                         });

TEST_P(SparsePropagationOn, GivesTheBeliefsOfTheWholeImageIfNoPixelIsCertain) {
  const auto [rows, cols] = GetParam();
  for (const double noise_m : {0.02, 0.15}) {
    const Walls walls(kinect_hz, rows, cols, noise_m, 1);
    const WrapCountBeliefs sparse = walls.sparse_beliefs(uncertain(rows, cols));
    const WrapCountBeliefs dense = walls.dense_beliefs();
    for (Eigen::Index at = 0; at < sparse.count.size(); ++at) {
      if (!walls.has_return(at)) continue;
      // Costs are bounded here, where the other one adds the probability of an outlier; and its
      // messages are rounded to 8 binary digits.
      EXPECT_NEAR(sparse.probability.data()[at], dense.probability.data()[at], 0.1) << at;
      if (dense.probability.data()[at] > 0.6F) {
        EXPECT_EQ(sparse.count.data()[at], dense.count.data()[at]) << at;
      }
      EXPECT_NEAR(sparse.probability.data()[at] + sparse.other_probability.data()[at], 1, 1e-5);
    }
  }
}

TEST(OwnCounts, AreCertainOnQuietSurfacesAndRightThere) {
  const Walls walls(kinect_hz, 60, 80, 0.02, 2);
  const OwnCounts own = walls.own();
  int certain = 0;
  for (Eigen::Index at = 0; at < own.count.size(); ++at) {
    if (own.certain.data()[at] == 0) continue;
    ++certain;
    EXPECT_TRUE(walls.has_return(at));
    EXPECT_EQ(own.count.data()[at], walls.true_count.data()[at]);
  }
  EXPECT_GT(certain, 0.8 * 60 * 80);
}

TEST(OwnCounts, BelieveWhatPropagationBelieves) {
  const Walls walls(kinect_hz, 60, 80, 0.02, 3);
  const OwnCounts own = walls.own();
  const WrapCountBeliefs dense = walls.dense_beliefs();
  double difference = 0;
  int certain = 0;
  for (Eigen::Index at = 0; at < own.count.size(); ++at) {
    if (own.certain.data()[at] == 0) continue;
    EXPECT_EQ(own.count.data()[at], dense.count.data()[at]);
    EXPECT_LT(dense.other_probability.data()[at], 1e-8);
    difference += std::log(own.odds_against.data()[at] / dense.other_probability.data()[at]);
    ++certain;
  }
  // One edge contributes up to 14 nats. Edges to neighbours that are not clear contribute here
  // nothing, and in the other beliefs something, for or against.
  EXPECT_NEAR(difference / certain, 0, 3);
}

TEST(OwnCounts, AreNotCertainInNoiseAndInMixedPixels) {
  Walls walls(kinect_hz, 40, 40, 1.2, 4);
  EXPECT_LT((walls.own().certain != 0).count(), 0.02 * 40 * 40) << "of phases that are noise";
  Walls quiet(kinect_hz, 40, 40, 0.02, 4);
  quiet.mixed.setOnes();
  EXPECT_EQ((quiet.own().certain != 0).count(), 0);
}

TEST(OwnCounts, LeaveAPixelOpenThatContradictsItsNeighbours) {
  Walls walls(kinect_hz, 9, 9, 0.01, 5);
  for (std::size_t f = 0; f < 3; ++f) {
    const double cycles = 12.0 / walls.limits.wavelengths_m[f];  // far from 3.1 m
    walls.frame.phases[f](4, 2) = static_cast<float>(cycles - std::floor(cycles));
  }
  const OwnCounts own = walls.own();
  EXPECT_EQ(own.certain(4, 2), 0);
  EXPECT_EQ(own.count(4, 2), static_cast<int>(12.0 / walls.limits.wavelength_m()));
}

/// The wrap counts that pixels have by themselves and by their blocks.
OwnCounts with_block_counts(const Walls& walls, const ImageU8& mixed) {
  OwnCounts own = walls.own();
  const NoisyFrame blocks = halve(walls.frame, walls.sigma);
  const OwnCounts of_blocks =
      find_own_counts(blocks.frame, walls.limits, blocks.sigma, walls.no_errors_m(), {},
                      ImageU8::Zero(blocks.frame.rows(), blocks.frame.cols()));
  take_block_counts(walls.frame, walls.limits, walls.sigma, walls.no_errors_m(), {}, mixed, blocks,
                    of_blocks, own);
  return own;
}

TEST(BlockCounts, MakeNoisyPixelsCertainAndRight) {
  const Walls walls(kinect_hz, 61, 81, 0.08, 9);
  const OwnCounts alone = walls.own();
  const OwnCounts own = with_block_counts(walls, walls.mixed);
  const Eigen::Index before = (alone.certain != 0).count();
  const Eigen::Index after = (own.certain != 0).count();
  EXPECT_GT(before, 400);
  EXPECT_GT(after, before + 400);
  int wrong = 0;
  for (Eigen::Index at = 0; at < own.count.size(); ++at) {
    if (own.certain.data()[at] == 0) continue;
    EXPECT_TRUE(walls.has_return(at));
    EXPECT_LE(own.odds_against.data()[at], 1e-8F);
    wrong += own.count.data()[at] != walls.true_count.data()[at] ? 1 : 0;
    if (alone.certain.data()[at] != 0) {
      EXPECT_EQ(own.odds_against.data()[at], alone.odds_against.data()[at]) << "stays as it is";
    }
  }
  EXPECT_LE(wrong, 3);
}

TEST(BlockCounts, LeaveMixedPixelsOpen) {
  const Walls walls(kinect_hz, 40, 40, 0.08, 10);
  const OwnCounts alone = walls.own();
  const OwnCounts own = with_block_counts(walls, ImageU8::Ones(40, 40));
  EXPECT_TRUE((own.certain == alone.certain).all());
}

TEST(SparsePropagation, FindsTheRightCountsBesideCertainPixels) {
  const Walls walls(kinect_hz, 60, 80, 0.08, 6);
  const OwnCounts own = walls.own();
  const WrapCountBeliefs beliefs = walls.sparse_beliefs(own);
  int wrong = 0;
  int uncertain_pixels = 0;
  for (Eigen::Index at = 0; at < own.count.size(); ++at) {
    if (!walls.has_return(at)) continue;
    uncertain_pixels += own.certain.data()[at] == 0 ? 1 : 0;
    wrong += beliefs.count.data()[at] != walls.true_count.data()[at] ? 1 : 0;
  }
  EXPECT_GT(uncertain_pixels, 200);
  EXPECT_LT(wrong, 10) << "at the edge between the walls, whose pixels are not mixed";
}

TEST(SparsePropagation, FindsTheRightOneOfMoreWrapCountsThanSlots) {
  for (const double far_wall_m : {7.3, 27.0, 41.0}) {
    const Walls walls(far_hz, 50, 60, 0.02, 11, far_wall_m);
    ASSERT_GT(walls.limits.count, static_cast<int>(UncertainPixels::slots));
    OwnCounts none_certain = walls.own();
    none_certain.certain.setZero();
    for (const OwnCounts& own : {none_certain, walls.own()}) {
      const WrapCountBeliefs beliefs = walls.sparse_beliefs(own);
      int wrong = 0;
      for (Eigen::Index at = 0; at < own.count.size(); ++at) {
        if (!walls.has_return(at)) continue;
        wrong += beliefs.count.data()[at] != walls.true_count.data()[at] ? 1 : 0;
      }
      EXPECT_LE(wrong, 2) << "far wall at " << far_wall_m << " m";
    }
  }
}

TEST(UncertainPixels, KeepTheLikeliestWrapCountOfEachSlot) {
  const Walls walls(far_hz, 20, 24, 0.02, 12, 41);
  const UncertainPixels pixels = walls.uncertain_pixels(uncertain(20, 24));
  ASSERT_TRUE(pixels.share_slots());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    float best = 0;
    for (std::size_t s = 0; s < UncertainPixels::slots; ++s) {
      const auto count = static_cast<int>(pixels.counts()[i * UncertainPixels::slots + s]);
      ASSERT_EQ(static_cast<std::size_t>(count) % UncertainPixels::slots, s);
      ASSERT_LT(count, walls.limits.count);
      const float evidence = pixels.evidence()[i * UncertainPixels::slots + s];
      best = std::max(best, evidence);
      if (count == walls.true_count.data()[pixels.raster()[i]]) {
        EXPECT_GT(evidence, 1e-3F) << "of the true wrap count";
      }
    }
    EXPECT_FLOAT_EQ(best, 1);
  }
}

TEST(UncertainPixels, TakeWeightsOfWrapCountsThatHaveNoSlot) {
  const Walls walls(far_hz, 4, 4, 0.02, 13);
  const AppendWeights append = [](int, std::vector<CountWeight>& weights) {
    weights.push_back({20, 1e9F});
    weights.push_back({20, 1e9F});
  };
  UncertainPixels pixels;
  pixels.assign(walls.frame, walls.limits, walls.sigma, walls.no_errors_m(), {}, uncertain(4, 4),
                walls.mixed, append);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const std::size_t slot = i * UncertainPixels::slots + 20 % UncertainPixels::slots;
    EXPECT_EQ(pixels.counts()[slot], 20);
    EXPECT_FLOAT_EQ(pixels.evidence()[slot], 1) << "10^18 against a least unary factor of 10^-8";
  }
}

TEST(SparsePropagation, ForgetsTheFrameBeforeIt) {
  const Walls first(kinect_hz, 30, 20, 0.1, 7);
  const Walls second(kinect_hz, 30, 20, 0.1, 8);
  UncertainPixels pixels;
  SparsePropagation propagation;
  WrapCountBeliefs beliefs;
  for (const Walls* walls : {&first, &second}) {
    pixels.assign(walls->frame, walls->limits, walls->sigma, walls->no_errors_m(), {}, walls->own(),
                  walls->mixed, {});
    beliefs = propagation.run(pixels, walls->own(), 3);
  }
  const WrapCountBeliefs fresh = second.sparse_beliefs(second.own());
  EXPECT_TRUE((beliefs.count == fresh.count).all());
  EXPECT_TRUE((beliefs.probability == fresh.probability).all());
}

}  // namespace
}  // namespace tofmap
