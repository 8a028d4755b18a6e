// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "correction_system.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

}  // namespace

FrameEquations::FrameEquations(std::span<const RelativeTerm> terms) {
  Matrix6d information = Matrix6d::Zero();
  for (const RelativeTerm& term : terms) {
    information += term.information;
    gradient_ += term.gradient;
  }
  information_.compute(information);
}

CorrectionSystem::CorrectionSystem(const std::vector<bool>& is_held) {
  int unknowns = 0;
  for (const bool held : is_held) unknown_of_.push_back(held ? -1 : unknowns++);
  gradient_ = Eigen::VectorXd::Zero(6 * unknowns);
  // Corrections are far smaller. Keyframes that nothing determines stay where they are.
  constexpr double sigma = 1;  // metres and radians
  for (int i = 0; i < unknowns; ++i) blocks_[{i, i}] = Matrix6d::Identity() / (sigma * sigma);
}

void CorrectionSystem::add(int row, int column, const Matrix6d& block) {
  const int i = unknown_of_[static_cast<std::size_t>(row)];
  const int k = unknown_of_[static_cast<std::size_t>(column)];
  if (i < 0 || k < 0 || i < k) return;
  const auto [entry, is_new] = blocks_.try_emplace({i, k}, block);
  if (!is_new) entry->second += block;
}

void CorrectionSystem::add(int row, const Vector6d& gradient) {
  const int i = unknown_of_[static_cast<std::size_t>(row)];
  if (i >= 0) gradient_.segment<6>(6 * i) += gradient;
}

void CorrectionSystem::add(int pose, const RelativeTerm& term) {
  const Matrix6d by_other = term.information * term.twist_by_keyframe;
  add(pose, pose, term.information);
  add(pose, term.keyframe, -by_other);
  add(term.keyframe, pose, -by_other.transpose());
  add(term.keyframe, term.keyframe, term.twist_by_keyframe.transpose() * by_other);
  add(pose, term.gradient);
  add(term.keyframe, Vector6d(-term.twist_by_keyframe.transpose() * term.gradient));
}

void CorrectionSystem::add_motion(const std::array<int, 3>& poses, const MotionTerm& term) {
  const Vector6d weights = term.sigmas.cwiseAbs2().cwiseInverse();
  const std::array<double, 3> parts = {term.share, -1 - term.share, 1};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t k = 0; k < poses.size(); ++k) {
      add(poses[i], poses[k], Matrix6d((parts[i] * parts[k] * weights).asDiagonal()));
    }
    add(poses[i], Vector6d(parts[i] * weights.cwiseProduct(term.change)));
  }
}

void CorrectionSystem::add_frame(std::span<const RelativeTerm> terms,
                                 const FrameEquations& equations) {
  for (const RelativeTerm& term : terms) {
    const Matrix6d& by_keyframe = term.twist_by_keyframe;
    const Matrix6d weighted = term.information * by_keyframe;
    const Matrix6d frame_by_keyframe = equations.information().solve(weighted);
    add(term.keyframe, term.keyframe, by_keyframe.transpose() * weighted);
    for (const RelativeTerm& other : terms) {
      add(other.keyframe, term.keyframe,
          -(other.information * other.twist_by_keyframe).transpose() * frame_by_keyframe);
    }
    add(term.keyframe, Vector6d(frame_by_keyframe.transpose() * equations.gradient() -
                                by_keyframe.transpose() * term.gradient));
  }
}

std::optional<Eigen::VectorXd> CorrectionSystem::solve() const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [place, block] : blocks_) {
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) {
        entries.emplace_back(6 * place.first + i, 6 * place.second + k, block(i, k));
      }
    }
  }
  if (gradient_.size() == 0) return Eigen::VectorXd::Zero(6 * std::ssize(unknown_of_));
  Eigen::SparseMatrix<double> matrix(gradient_.size(), gradient_.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  if (solver.info() != Eigen::Success || !(solver.vectorD().array() > 0).all()) return std::nullopt;
  const Eigen::VectorXd solution = solver.solve(-gradient_);
  if (!solution.allFinite()) return std::nullopt;
  Eigen::VectorXd corrections = Eigen::VectorXd::Zero(6 * std::ssize(unknown_of_));
  for (std::size_t pose = 0; pose < unknown_of_.size(); ++pose) {
    const int i = unknown_of_[pose];
    if (i >= 0) corrections.segment<6>(6 * static_cast<int>(pose)) = solution.segment<6>(6 * i);
  }
  return corrections;
}

Vector6d frame_correction(std::span<const RelativeTerm> terms, const FrameEquations& equations,
                          const Eigen::VectorXd& of_keyframes) {
  Vector6d gradient = equations.gradient();
  for (const RelativeTerm& term : terms) {
    gradient -=
        term.information * (term.twist_by_keyframe * of_keyframes.segment<6>(6 * term.keyframe));
  }
  return -equations.information().solve(gradient);
}

}  // namespace tofmap
