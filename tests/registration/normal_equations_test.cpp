// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "normal_equations.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace tofmap {
namespace {

using Eigen::Vector3d;

Correspondence pair_at(const Vector3d& point_m, const Vector3d& normal) {
  Correspondence pair;
  pair.point_m = point_m;
  pair.normal = normal;
  pair.variance_m2 = 1e-4;
  return pair;
}

/// Points spread evenly over the faces of a cube around the origin, normals outwards.
std::vector<Correspondence> cube(double half_side_m) {
  constexpr int steps = 20;
  std::vector<Correspondence> pairs;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
          Vector3d point;
          point[axis] = side * half_side_m;
          point[(axis + 1) % 3] = half_side_m * ((2 * i + 1.0) / steps - 1);
          point[(axis + 2) % 3] = half_side_m * ((2 * j + 1.0) / steps - 1);
          pairs.push_back(pair_at(point, side * Vector3d::Unit(axis)));
        }
      }
    }
  }
  return pairs;
}

std::vector<Correspondence> wall(double distance_m) {
  std::vector<Correspondence> pairs;
  for (int i = -10; i <= 10; ++i) {
    for (int j = -10; j <= 10; ++j) {
      pairs.push_back(pair_at({0.1 * i, 0.1 * j, distance_m}, -Vector3d::UnitZ()));
    }
  }
  return pairs;
}

std::vector<Correspondence> with_residuals(int count, double deviations, double outlier_share) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0, deviations);
  std::vector<Correspondence> pairs;
  for (int i = 0; i < count; ++i) {
    Correspondence pair = pair_at(Vector3d::Zero(), Vector3d::UnitZ());
    pair.residual_m = std::sqrt(pair.variance_m2) * normal(random);
    if (i < outlier_share * count) pair.residual_m = i % 2 == 0 ? 1 : -1;
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(RobustScale, IsTheStandardDeviationOfGaussianResiduals) {
  // The median deviation of N draws has a relative standard deviation of 1.17 / √N: 0.8 %.
  for (const double deviations : {1.5, 2.0, 5.0}) {
    EXPECT_NEAR(robust_scale(with_residuals(20000, deviations, 0)) / deviations, 1, 0.03);
  }
}

TEST(RobustScale, IsNotBelowThePredictedNoise) {
  EXPECT_EQ(robust_scale(with_residuals(1000, 0.3, 0)), 1);
  EXPECT_EQ(robust_scale({}), 1);
}

TEST(RobustScale, GrowsNoMoreThanOutliersShiftTheMedian) {
  // With 20 % of outliers the median is the 62.5 % quantile of the others: 1.4826 · 0.887.
  EXPECT_NEAR(robust_scale(with_residuals(20000, 2, 0.2)) / 2, 1.315, 0.04);
}

TEST(Observability, OfACubeIsThatOfItsFaces) {
  constexpr double half_side_m = 2;
  const Observability seen = observability(build_equations(cube(half_side_m), 3), half_side_m);
  // A rotation about x moves points on four of the six faces along their normals, by the square of
  // one coordinate: 4/6 · (a² / 3) / a². A third of the normals are along each axis.
  constexpr double rotation = 2.0 / 9;
  constexpr double translation = 1.0 / 3;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen.shares[i], rotation, 2e-3) << i;
  for (int i = 3; i < 6; ++i) EXPECT_NEAR(seen.shares[i], translation, 1e-9) << i;
  EXPECT_GT(std::abs(seen.directions.topLeftCorner(3, 3).determinant()), 0.999)
      << "the first three are the rotations";
}

TEST(Observability, LeavesThreeDirectionsOfAWallAtZero) {
  const Observability seen = observability(build_equations(wall(3), 3), 3);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen.shares[i], 0, 1e-12) << i;
  EXPECT_GT(seen.shares[3], 0.01);
  // Along the wall and about its normal; not towards it.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(seen.directions(5, i), 0, 1e-9);
}

TEST(Observability, IsTheShareOfEveryDirection) {
  const NormalEquations equations = build_equations(cube(1.5), 3);
  const Observability seen = observability(equations, 1);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 100; ++i) {
    const Vector6d direction = Vector6d::NullaryExpr([&] { return normal(random); }).normalized();
    const Vector6d twist = seen.scale.cwiseProduct(direction);
    double sum = 0;
    double weights = 0;
    for (const Correspondence& pair : cube(1.5)) {
      sum += std::pow(residual_jacobian(pair).dot(twist), 2);
      weights += 1;
    }
    const double share = (seen.directions.transpose() * direction).cwiseAbs2().dot(seen.shares);
    EXPECT_NEAR(share, sum / weights, 1e-9);
  }
}

TEST(DegenerateDirections, AreThoseThatThePriorKnowsBetter) {
  const NormalEquations equations = build_equations(wall(3), 3);
  const Observability seen = observability(equations, 3);
  EXPECT_EQ(degenerate_directions(seen, equations, Vector6d::Constant(0.1)).size(), 3U);
  // 441 points of 1 cm: towards the wall, the mean is known within half a millimetre.
  EXPECT_EQ(degenerate_directions(seen, equations, Vector6d::Constant(1e-6)).size(), 6U);
  NormalEquations of_noise = equations;
  of_noise.noise_induced = 0.6 * equations.information;
  EXPECT_EQ(degenerate_directions(seen, of_noise, Vector6d::Constant(0.1)).size(), 6U)
      << "twice the noise-induced information is more than there is";
}

TEST(SurfaceInformation, IsAllOfItWithoutNoiseOfNormals) {
  const NormalEquations equations = build_equations(cube(2), 3);
  const Matrix6d information = surface_information(observability(equations, 2), equations);
  EXPECT_LT((information - equations.information).norm(), 1e-9 * equations.information.norm());
}

TEST(SurfaceInformation, IsThatOfASolutionWhoseGradientIsNoisier) {
  NormalEquations equations = build_equations(cube(2), 3);
  constexpr double share = 0.3;
  equations.noise_induced = share * equations.information;
  const Matrix6d information = surface_information(observability(equations, 2), equations);
  // H / (H - 2 N)² is the variance.
  const double expected = (1 - 2 * share) * (1 - 2 * share);
  EXPECT_LT((information - expected * equations.information).norm(),
            1e-9 * equations.information.norm());
  equations.noise_induced = 0.6 * equations.information;
  EXPECT_TRUE(surface_information(observability(equations, 2), equations).isZero(0));
}

TEST(RemoveInformation, LeavesNothingAlongADirectionAndTheOthersAsTheyAre) {
  NormalEquations equations = build_equations(cube(2), 3);
  equations.gradient << 1, 2, 3, 4, 5, 6;
  const NormalEquations before = equations;
  const Observability seen = observability(equations, 2);
  remove_information(equations, seen, std::vector<int>{1, 4});
  for (int i = 0; i < 6; ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const bool is_removed = i == 1 || i == 4;
    const double information = twist.dot(before.information * twist);
    EXPECT_NEAR(twist.dot(equations.information * twist), is_removed ? 0 : information,
                1e-9 * information);
    EXPECT_NEAR(twist.dot(equations.gradient), is_removed ? 0 : twist.dot(before.gradient), 1e-9);
  }
}

TEST(NoiseInducedInformation, IsWhatTiltedNormalsAddOnAverage) {
  constexpr double sigma_rad = 0.05;
  Correspondence pair = pair_at({0.7, -0.4, 2.1}, Vector3d(0.3, 0.5, -0.8).normalized());
  pair.normal_sigma_rad = sigma_rad;
  const NormalEquations predicted = build_equations(std::vector{pair}, 3);
  std::mt19937 random(6);
  std::normal_distribution<double> tilt(0, sigma_rad);
  Matrix6d added = Matrix6d::Zero();
  constexpr int draws = 200000;
  for (int i = 0; i < draws; ++i) {
    Vector3d noise(tilt(random), tilt(random), tilt(random));
    noise -= pair.normal.dot(noise) * pair.normal;
    for (const double sign : {-1.0, 1.0}) {  // so that tilts of first order cancel
      Correspondence tilted = pair;
      tilted.normal = pair.normal + sign * noise;
      const Vector6d jacobian = residual_jacobian(tilted);
      added += jacobian * jacobian.transpose() / pair.variance_m2 / (2 * draws);
    }
  }
  added -= predicted.information;
  // The mean of so many squares of normal numbers is known within √(2 / draws), 0.3 %.
  EXPECT_LT((added - predicted.noise_induced).norm(), 0.015 * predicted.noise_induced.norm());
}

}  // namespace
}  // namespace tofmap
