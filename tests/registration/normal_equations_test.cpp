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
  pair.source_normal = normal;
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
      sum += std::pow(residual_jacobian(pair.point_m, pair.normal).dot(twist), 2);
      weights += 1;
    }
    const double share = (seen.directions.transpose() * direction).cwiseAbs2().dot(seen.shares);
    EXPECT_NEAR(share, sum / weights, 1e-9);
  }
}

TEST(DegenerateDirections, AreThoseThatThePriorKnowsBetter) {
  const NormalEquations equations = build_equations(wall(3), 3);
  const Observability seen = observability(equations, 3);
  EXPECT_EQ(degenerate_directions(seen, equations.information, Vector6d::Constant(0.1)).size(), 3U);
  // 441 points of 1 cm: towards the wall, the mean is known within half a millimetre.
  EXPECT_EQ(degenerate_directions(seen, equations.information, Vector6d::Constant(1e-6)).size(),
            6U);
  NormalEquations of_noise = equations;
  of_noise.noise_induced = equations.information;
  keep_shares(of_noise, seen, surface_shares(seen, of_noise));
  EXPECT_EQ(degenerate_directions(seen, of_noise.information, Vector6d::Constant(0.1)).size(), 6U)
      << "all information is noise-induced";
}

TEST(SurfaceShares, AreOneWithoutNoiseOfNormals) {
  const NormalEquations equations = build_equations(cube(2), 3);
  EXPECT_EQ(surface_shares(observability(equations, 2), equations), Vector6d::Ones());
}

TEST(SurfaceShares, AreZeroWhereThereIsNoInformation) {
  const NormalEquations equations = build_equations(wall(3), 3);
  const Vector6d shares = surface_shares(observability(equations, 3), equations);
  EXPECT_EQ(shares.tail(3), Eigen::Vector3d::Ones());
  EXPECT_EQ(surface_shares(observability({}, 3), {}), Vector6d::Zero());
}

TEST(KeepShares, GivesTheSolutionWithoutBiasAndItsVariance) {
  NormalEquations equations = build_equations(cube(2), 3);
  equations.gradient << 1, 2, 3, 4, 5, 6;
  constexpr double noise_induced = 0.3;
  equations.noise_induced = noise_induced * equations.information;
  const Observability seen = observability(equations, 2);
  NormalEquations kept = equations;
  keep_shares(kept, seen, surface_shares(seen, equations));
  // Without noise, the information would be H - N. The variance is H / (H - 1.25 N)².
  const Matrix6d without_noise = (1 - noise_induced) * equations.information;
  const Vector6d solution = without_noise.ldlt().solve(equations.gradient);
  EXPECT_LT((kept.information.ldlt().solve(kept.gradient) - solution).norm(),
            1e-9 * solution.norm());
  const Matrix6d expected = std::pow(1 - 1.25 * noise_induced, 2) * equations.information;
  EXPECT_LT((kept.information - expected).norm(), 1e-9 * expected.norm());
}

TEST(KeepShares, LeavesNothingAlongADirectionAndTheOthersAsTheyAre) {
  NormalEquations equations = build_equations(cube(2), 3);
  equations.gradient << 1, 2, 3, 4, 5, 6;
  const NormalEquations before = equations;
  const Observability seen = observability(equations, 2);
  Vector6d shares = Vector6d::Ones();
  shares[1] = shares[4] = 0;
  keep_shares(equations, seen, shares);
  for (int i = 0; i < 6; ++i) {
    const Vector6d twist = seen.scale.cwiseProduct(seen.directions.col(i));
    const double information = twist.dot(before.information * twist);
    EXPECT_NEAR(twist.dot(equations.information * twist), shares[i] * information,
                1e-9 * information);
    EXPECT_NEAR(twist.dot(equations.gradient), shares[i] * twist.dot(before.gradient), 1e-9);
  }
}

/// Tilts a normal by a random angle about each axis along its plane.
class RandomTilt {
 public:
  explicit RandomTilt(double sigma_rad) : tilt_(0, sigma_rad) {}
  Vector3d operator()(const Vector3d& normal) {
    const Vector3d noise(tilt_(random_), tilt_(random_), tilt_(random_));
    return (normal + noise - normal.dot(noise) * normal).normalized();
  }

 private:
  std::mt19937 random_{6};
  std::normal_distribution<double> tilt_;
};

TEST(NoiseInducedInformation, IsWhatNoiseOfNormalsAdds) {
  const NormalEquations without_noise = build_equations(cube(2), 3);
  constexpr double sigma_rad = 0.1;
  RandomTilt tilted(sigma_rad);
  Matrix6d information = Matrix6d::Zero();
  Matrix6d noise_induced = Matrix6d::Zero();
  constexpr int draws = 300;
  for (int i = 0; i < draws; ++i) {
    std::vector<Correspondence> pairs = cube(2);
    for (Correspondence& pair : pairs) {
      pair.normal = tilted(pair.normal);
      pair.source_normal = tilted(pair.source_normal);
    }
    const NormalEquations equations = build_equations(pairs, 3);
    information += equations.information / draws;
    noise_induced += equations.noise_induced / draws;
  }
  // The mean of both normals has half the variance of one, 0.005 of the squared Jacobians. What it
  // takes from the length along the true normal is of the same order, and as large in the products
  // of the Jacobians, from which it is not told apart.
  const Matrix6d rest = information - noise_induced;
  constexpr double shortened = 4 * sigma_rad * sigma_rad;
  EXPECT_LT((rest - without_noise.information).norm(),
            shortened * without_noise.information.norm());
  EXPECT_GT(noise_induced.trace(), 0.3 * sigma_rad * sigma_rad * information.trace());
}

TEST(NoiseInducedInformation, IsAllThatAWallHasAlongItself) {
  constexpr double sigma_rad = 0.1;
  RandomTilt tilted(sigma_rad);
  std::vector<Correspondence> pairs = wall(3);
  for (Correspondence& pair : pairs) {
    pair.normal = tilted(pair.normal);
    pair.source_normal = tilted(pair.source_normal);
  }
  const NormalEquations equations = build_equations(pairs, 3);
  Vector6d sideways = Vector6d::Zero();
  sideways[3] = 1;
  const double all = sideways.dot(equations.information * sideways);
  // Both normals' mean has the variance σ² / 2. N squares of normal numbers have a relative
  // standard deviation of √(2 / N), 7 %.
  const double expected = sigma_rad * sigma_rad / 2 * equations.weight_sum;
  EXPECT_NEAR(all, expected, 4 * 0.07 * expected);
  const double noise_induced = sideways.dot(equations.noise_induced * sideways);
  EXPECT_NEAR(noise_induced, expected, 4 * 0.07 * expected);
}

}  // namespace
}  // namespace tofmap
