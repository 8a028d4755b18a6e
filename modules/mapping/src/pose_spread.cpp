// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/pose_spread.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace tofmap {
namespace {

double largest_eigenvalue(const Eigen::Matrix3d& covariance) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

}  // namespace

double PoseSpread::rotation_sigma_rad() const { return std::sqrt(rotation_rad2); }
double PoseSpread::translation_sigma_m() const { return std::sqrt(translation_m2); }

PoseSpread operator+(const PoseSpread& one, const PoseSpread& other) {
  return {one.rotation_rad2 + other.rotation_rad2, one.translation_m2 + other.translation_m2};
}

PoseSpread smaller(const PoseSpread& one, const PoseSpread& other) {
  return one.translation_m2 < other.translation_m2 ? one : other;
}

PoseSpread larger(const PoseSpread& one, const PoseSpread& other) {
  return one.translation_m2 < other.translation_m2 ? other : one;
}

PoseSpread spread_of(const Eigen::Matrix<double, 6, 6>& covariance) {
  return {largest_eigenvalue(covariance.topLeftCorner<3, 3>()),
          largest_eigenvalue(covariance.bottomRightCorner<3, 3>())};
}

}  // namespace tofmap
