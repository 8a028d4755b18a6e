// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "bit_matrix.hpp"

#include <random>

#include <gtest/gtest.h>
#include <support/box_ranges.hpp>

#include <tofmap/registration/global_alignment.hpp>

namespace tofmap {
namespace {

Eigen::Vector3f random_vector(std::mt19937& random, float most) {
  std::uniform_real_distribution<float> number(-most, most);
  return {number(random), number(random), number(random)};
}

OrientedCloud random_cloud(std::mt19937& random, int points) {
  std::vector<Eigen::Vector3f> places;
  std::vector<Eigen::Vector3f> normals;
  for (int i = 0; i < points; ++i) {
    places.push_back(random_vector(random, 5));
    normals.push_back(random_vector(random, 1).normalized());
  }
  const PointSearch search(places);
  return {places, normals, 0.1, search};
}

OrientedCloud moved(const OrientedCloud& cloud, const Pose& pose) {
  std::vector<Eigen::Vector3f> places;
  std::vector<Eigen::Vector3f> normals;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    places.emplace_back((pose * cloud.points_m[i].cast<double>()).cast<float>());
    normals.emplace_back((pose.linear() * cloud.normals[i].cast<double>()).cast<float>());
  }
  const PointSearch search(places);
  return {places, normals, cloud.voxel_m, search};
}

TEST(GuessAlignments, FindsThePoseThatOneMatchInTwentyTells) {
  std::mt19937 random(3);
  const OrientedCloud source = random_cloud(random, 1000);
  const Pose pose = test::moved_by({1, 2, -0.5}, {3, -7, 2});
  const OrientedCloud target = moved(source, pose);
  std::uniform_int_distribution<int> any(0, 999);
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < 1000; ++i) matches.push_back({i, i % 20 == 0 ? i : any(random)});
  const auto guesses = guess_alignments(source, target, matches);
  ASSERT_FALSE(guesses.empty());
  EXPECT_GE(guesses[0].support, 50);
  EXPECT_LT(rotation_angle_rad(guesses[0].target_from_source, pose), 1e-4);
  EXPECT_LT((guesses[0].target_from_source.translation() - pose.translation()).norm(), 1e-3);
}

TEST(GuessAlignments, FindsNothingInChance) {
  std::mt19937 random(4);
  const OrientedCloud source = random_cloud(random, 1000);
  const OrientedCloud target = random_cloud(random, 1000);
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < 1000; ++i) matches.push_back({i, i});
  for (const AlignmentGuess& guess : guess_alignments(source, target, matches)) {
    EXPECT_LT(guess.support, 12);
  }
}

TEST(GuessAlignments, HasNoneFromMatchesThatAreAllInOnePlace) {
  // Within the tolerance of their distances any of these would be compatible with any other, but
  // they say nothing of a rotation.
  std::mt19937 random(8);
  std::vector<Eigen::Vector3f> places;
  for (int i = 0; i < 100; ++i) places.push_back(random_vector(random, 0.05F));
  const std::vector<Eigen::Vector3f> normals(100, Eigen::Vector3f::UnitZ());
  const PointSearch search(places);
  const OrientedCloud cloud{places, normals, 0.1, search};
  std::vector<FeatureMatch> matches;
  for (int i = 0; i < 100; ++i) matches.push_back({i, (i * 37 + 11) % 100});
  EXPECT_TRUE(guess_alignments(cloud, cloud, matches).empty());
}

TEST(GuessAlignments, HasNoneWithoutMatches) {
  std::mt19937 random(5);
  const OrientedCloud cloud = random_cloud(random, 100);
  EXPECT_TRUE(guess_alignments(cloud, cloud, {}).empty());
}

TEST(MatchFeatures, PairsThoseThatLookMostLikeEachOther) {
  std::vector<PointFeature> source(3, PointFeature{});
  std::vector<PointFeature> target(2, PointFeature{});
  source[0][5] = 100;
  source[1][7] = 100;
  source[2][7] = 80;  // like the second, but less so
  target[0][7] = 99;
  target[1][5] = 98;
  const auto matches = match_features(source, target);
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].target, 1);
  EXPECT_EQ(matches[1].source, 1);
  EXPECT_TRUE(match_features(source, {}).empty());
}

TEST(PointSearch, FindsWhatComparingAllFinds) {
  std::mt19937 random(6);
  const OrientedCloud cloud = random_cloud(random, 500);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3f place = random_vector(random, 7);
    std::size_t nearest = 0;
    for (std::size_t j = 0; j < cloud.size(); ++j) {
      if ((cloud.points_m[j] - place).norm() < (cloud.points_m[nearest] - place).norm()) {
        nearest = j;
      }
    }
    const auto found = cloud.search.nearest(place, 100);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->index, nearest);
    EXPECT_FALSE(cloud.search.nearest(place, 0.9 * std::sqrt(found->squared_gap_m2)));
  }
}

TEST(BitMatrix, CountsWhatRowsHaveInCommon) {
  std::mt19937 random(7);
  constexpr std::size_t size = 130;  // more than two words a row
  BitMatrix matrix(size);
  std::vector<std::vector<bool>> plain(size, std::vector<bool>(size, false));
  std::bernoulli_distribution coin(0.3);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j < size; ++j) {
      if (!coin(random)) continue;
      matrix.set(i, j);
      plain[i][j] = true;
    }
  }
  for (std::size_t i = 0; i < size; i += 13) {
    for (std::size_t j = 0; j < size; j += 7) {
      int common = 0;
      for (std::size_t k = 0; k < size; ++k) common += plain[i][k] && plain[j][k] ? 1 : 0;
      EXPECT_EQ(matrix.common(i, j), common);
      EXPECT_EQ(matrix(i, j), plain[i][j]);
    }
  }
}

}  // namespace
}  // namespace tofmap
