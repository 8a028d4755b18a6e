// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/path_uncertainty.hpp"

#include <cmath>
#include <cstddef>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/SparseCholesky>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Sparse = Eigen::SparseMatrix<double>;

/// Degrees of freedom of a pose: rotation vector, then translation, both along the world's axes.
constexpr int dofs = 6;

/// Adds a block unless it is of a pose that is held, whose index is negative.
void add_block(const Matrix6d& block, int row, int col,
               std::vector<Eigen::Triplet<double>>& entries) {
  if (row < 0 || col < 0) return;
  for (int i = 0; i < dofs; ++i) {
    for (int k = 0; k < dofs; ++k) {
      entries.emplace_back(dofs * row + i, dofs * col + k, block(i, k));
    }
  }
}

/// The information of all edges about the errors of all poses but the first `held`, which are
/// exact.
Sparse information_of(std::span<const Pose> poses, std::span<const PoseEdge> edges,
                      std::size_t held = 0) {
  // Keeps the system regular: nothing else holds the path as a whole, or poses without edges.
  constexpr double hold_sigma = 100;  // radians or metres
  std::vector<Eigen::Triplet<double>> entries;
  const int first = static_cast<int>(held);
  const int size = dofs * (static_cast<int>(poses.size()) - first);
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1 / (hold_sigma * hold_sigma));
  for (const PoseEdge& edge : edges) {
    const Pose& from = poses[static_cast<std::size_t>(edge.from)];
    const Pose& to = poses[static_cast<std::size_t>(edge.to)];
    // An error of `from` moves `to` with it.
    const Matrix6d by_from = -twist_at_offset(to.translation() - from.translation());
    const Matrix6d information = rotated(edge.covariance.inverse(), from.linear());
    const int row = edge.from - first;
    const int col = edge.to - first;
    add_block(by_from.transpose() * information * by_from, row, row, entries);
    add_block(by_from.transpose() * information, row, col, entries);
    add_block(information * by_from, col, row, entries);
    add_block(information, col, col, entries);
  }
  Sparse matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Takes the part out of the errors of a path that is a rigid motion: the one that fits the errors
/// of the positions best.
class Alignment {
 public:
  explicit Alignment(std::span<const Pose> poses) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (const Pose& pose : poses) centre += pose.translation() / static_cast<double>(poses.size());
    Matrix6d normal = Matrix6d::Zero();
    for (const Pose& pose : poses) {
      motions_.emplace_back(twist_at_offset(pose.translation() - centre).bottomRows<3>());
      normal += motions_.back().transpose() * motions_.back();
    }
    // Positions along a line or at a point do not tell all rotations.
    solver_.compute(normal);
  }

  void align(Eigen::VectorXd& errors) const {
    Vector6d sum = Vector6d::Zero();
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      sum += motions_[i].transpose() * position(errors, i);
    }
    const Vector6d motion = solver_.solve(sum);
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      position(errors, i) -= motions_[i] * motion;
      rotation(errors, i) -= motion.head<3>();
    }
  }

  static Eigen::VectorBlock<Eigen::VectorXd, 3> rotation(Eigen::VectorXd& errors, std::size_t i) {
    return errors.segment<3>(dofs * static_cast<Eigen::Index>(i));
  }
  static Eigen::VectorBlock<Eigen::VectorXd, 3> position(Eigen::VectorXd& errors, std::size_t i) {
    return errors.segment<3>(dofs * static_cast<Eigen::Index>(i) + 3);
  }

 private:
  std::vector<Eigen::Matrix<double, 3, 6>> motions_;  ///< error of each position by a motion
  Eigen::CompleteOrthogonalDecomposition<Matrix6d> solver_;
};

}  // namespace

std::vector<ExpectedError> expected_errors(std::span<const Pose> poses,
                                           std::span<const PoseEdge> edges) {
  check_edges(edges, poses.size());
  std::vector<ExpectedError> expected(poses.size());
  if (poses.size() < 2) return expected;
  const Eigen::SimplicialLLT<Sparse> factors(information_of(poses, edges));
  const Alignment alignment(poses);
  constexpr int draws = 256;
  std::mt19937_64 bits;
  Eigen::VectorXd errors(dofs * static_cast<Eigen::Index>(poses.size()));
  for (int draw = 0; draw < draws; ++draw) {
    // Errors that are solutions for random signs have the covariance of the system.
    for (double& sign : errors) sign = (bits() & 1) != 0 ? 1 : -1;
    factors.matrixU().solveInPlace(errors);
    errors = factors.permutationPinv() * errors;
    alignment.align(errors);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      expected[i].rotation_rad += Alignment::rotation(errors, i).squaredNorm() / draws;
      expected[i].position_m += Alignment::position(errors, i).squaredNorm() / draws;
    }
  }
  for (ExpectedError& error : expected) {
    error = {std::sqrt(error.rotation_rad), std::sqrt(error.position_m)};
  }
  return expected;
}

std::vector<Matrix6d> covariances_beside(std::span<const Pose> poses,
                                         std::span<const PoseEdge> edges, std::size_t held) {
  check_edges(edges, poses.size());
  std::vector<Matrix6d> covariances;
  if (held >= poses.size()) return covariances;
  const Eigen::SimplicialLLT<Sparse> factors(information_of(poses, edges, held));
  const auto count = static_cast<Eigen::Index>(poses.size() - held);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(dofs * count, dofs);
    columns.middleRows<dofs>(dofs * i).setIdentity();
    covariances.emplace_back(factors.solve(columns).middleRows<dofs>(dofs * i));
  }
  return covariances;
}

}  // namespace tofmap
