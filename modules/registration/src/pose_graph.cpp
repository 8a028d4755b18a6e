// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <Eigen/Cholesky>
#include <boost/pending/disjoint_sets.hpp>
#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <tofmap/core/error.hpp>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A pose in the parameters that Ceres optimises.
struct Node {
  Eigen::Quaterniond rotation;
  Eigen::Vector3d translation_m;
};

/// The whitened error of an edge: six residuals with unit variance.
class EdgeError {
 public:
  explicit EdgeError(const PoseEdge& edge)
      : rotation_(Eigen::Quaterniond(edge.from_from_to.linear()).normalized()),
        translation_m_(edge.from_from_to.translation()) {
    const Matrix6d information = edge.covariance.inverse();
    whitening_ = Eigen::LLT<Matrix6d>(information).matrixU();
  }

  template <class Scalar>
  bool operator()(const Scalar* from_rotation, const Scalar* from_translation,
                  const Scalar* to_rotation, const Scalar* to_translation, Scalar* residual) const {
    using Vector = Eigen::Matrix<Scalar, 3, 1>;
    using Quaternion = Eigen::Quaternion<Scalar>;
    const Eigen::Map<const Quaternion> q_from(from_rotation);
    const Eigen::Map<const Quaternion> q_to(to_rotation);
    const Eigen::Map<const Vector> t_from(from_translation);
    const Eigen::Map<const Vector> t_to(to_translation);
    const Quaternion rotation =
        q_from.conjugate() * q_to * rotation_.conjugate().template cast<Scalar>();
    const Scalar wxyz[4] = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
    Eigen::Matrix<Scalar, 6, 1> error;
    ceres::QuaternionToAngleAxis(wxyz, error.data());
    error.template tail<3>() =
        q_from.conjugate() * (t_to - t_from) - translation_m_.template cast<Scalar>();
    Eigen::Map<Eigen::Matrix<Scalar, 6, 1>>{residual} = whitening_.template cast<Scalar>() * error;
    return true;
  }

 private:
  Eigen::Quaterniond rotation_;
  Eigen::Vector3d translation_m_;
  Matrix6d whitening_;
};

/// Kernel of Geman and McClure on the squared error s: ρ(s) = s / (1 + s / w²), where w is the
/// width.
class GemanMcClureLoss : public ceres::LossFunction {
 public:
  explicit GemanMcClureLoss(double width) : inverse_square_(1 / (width * width)) {}

  void Evaluate(double squared, double out[3]) const override {
    const double share = 1 / (1 + squared * inverse_square_);
    out[0] = squared * share;
    out[1] = share * share;
    out[2] = -2 * inverse_square_ * share * share * share;
  }

 private:
  double inverse_square_;
};

Node node_of(const Pose& pose) {
  return {Eigen::Quaterniond(pose.linear()).normalized(), pose.translation()};
}

/// The poses that are held: the first `held` ones, and the first pose of each set of poses that
/// edges connect.
std::vector<std::size_t> held_poses(std::span<const PoseEdge> edges, std::size_t poses,
                                    std::size_t held) {
  boost::disjoint_sets_with_storage<> components(poses);
  for (std::size_t pose = 0; pose < poses; ++pose) components.make_set(pose);
  for (const PoseEdge& edge : edges) {
    components.union_set(static_cast<std::size_t>(edge.from), static_cast<std::size_t>(edge.to));
  }
  std::vector<bool> is_known(poses);
  std::vector<std::size_t> firsts;
  for (std::size_t pose = 0; pose < poses; ++pose) {
    const std::size_t component = components.find_set(pose);
    if (!is_known[component] || pose < held) firsts.push_back(pose);
    is_known[component] = true;
  }
  return firsts;
}

/// One pass of optimisation with a fixed kernel. Updates `nodes` but those that are held.
ceres::Solver::Summary solve(std::span<const PoseEdge> edges, double kernel_width,
                             std::span<const std::size_t> held, std::vector<Node>& nodes) {
  // The manifold and the kernel are shared by all blocks and live on the stack.
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::EigenQuaternionManifold rotations;
  GemanMcClureLoss kernel(kernel_width);
  ceres::Problem problem(ownership);
  for (Node& node : nodes) {
    problem.AddParameterBlock(node.rotation.coeffs().data(), 4, &rotations);
    problem.AddParameterBlock(node.translation_m.data(), 3);
  }
  for (const std::size_t node : held) {
    problem.SetParameterBlockConstant(nodes[node].rotation.coeffs().data());
    problem.SetParameterBlockConstant(nodes[node].translation_m.data());
  }
  for (const PoseEdge& edge : edges) {
    Node& from = nodes[static_cast<std::size_t>(edge.from)];
    Node& to = nodes[static_cast<std::size_t>(edge.to)];
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<EdgeError, 6, 4, 3, 4, 3>(new EdgeError(edge)),
        edge.may_be_wrong ? &kernel : nullptr, from.rotation.coeffs().data(),
        from.translation_m.data(), to.rotation.coeffs().data(), to.translation_m.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;  // makes results reproducible to the bit
  options.max_num_iterations = 50;
  options.function_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

}  // namespace

void check_edges(std::span<const PoseEdge> edges, std::size_t poses) {
  for (const PoseEdge& edge : edges) {
    const auto is_there = [&](int pose) {
      return pose >= 0 && static_cast<std::size_t>(pose) < poses;
    };
    if (!is_there(edge.from) || !is_there(edge.to) || edge.from == edge.to) {
      throw UsageError("pose graph of " + std::to_string(poses) + " poses: an edge from " +
                       std::to_string(edge.from) + " to " + std::to_string(edge.to));
    }
  }
}

double mahalanobis_distance(const PoseEdge& edge, const std::vector<Pose>& poses) {
  const Node from = node_of(poses[static_cast<std::size_t>(edge.from)]);
  const Node to = node_of(poses[static_cast<std::size_t>(edge.to)]);
  Eigen::Matrix<double, 6, 1> residual;
  const EdgeError error(edge);
  error(from.rotation.coeffs().data(), from.translation_m.data(), to.rotation.coeffs().data(),
        to.translation_m.data(), residual.data());
  return residual.norm();
}

void widen(PoseEdge& edge, double rotation_sigma_rad, double translation_sigma_m) {
  edge.covariance.diagonal().head<3>().array() += rotation_sigma_rad * rotation_sigma_rad;
  edge.covariance.diagonal().tail<3>().array() += translation_sigma_m * translation_sigma_m;
}

Eigen::Matrix<double, 6, 6> rotated(const Eigen::Matrix<double, 6, 6>& matrix,
                                    const Eigen::Matrix3d& new_from_old) {
  Matrix6d rotation = Matrix6d::Zero();
  rotation.topLeftCorner<3, 3>() = new_from_old;
  rotation.bottomRightCorner<3, 3>() = new_from_old;
  return rotation * matrix * rotation.transpose();
}

Eigen::Matrix<double, 6, 1> rotated_twist(const Eigen::Matrix<double, 6, 1>& twist,
                                          const Eigen::Matrix3d& new_from_old) {
  Eigen::Matrix<double, 6, 1> along_new;
  along_new << new_from_old * twist.head<3>(), new_from_old * twist.tail<3>();
  return along_new;
}

Eigen::Matrix<double, 6, 6> twist_at_offset(const Eigen::Vector3d& offset_m) {
  Matrix6d matrix = Matrix6d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    matrix.block<3, 1>(3, axis) = Eigen::Vector3d::Unit(axis).cross(offset_m);
  }
  return matrix;
}

PoseGraphResult optimise_pose_graph(std::vector<Pose> poses, std::span<const PoseEdge> edges,
                                    double kernel_width, std::size_t held) {
  check_edges(edges, poses.size());
  PoseGraphResult result;
  result.poses = std::move(poses);
  if (result.poses.empty()) return result;
  std::vector<Node> nodes;
  for (const Pose& pose : result.poses) nodes.push_back(node_of(pose));
  double width = kernel_width;
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) width = std::max(width, 2 * mahalanobis_distance(edge, result.poses));
  }
  const std::vector<std::size_t> fixed = held_poses(edges, nodes.size(), held);
  while (true) {
    const ceres::Solver::Summary summary = solve(edges, width, fixed, nodes);
    result.iterations += static_cast<int>(summary.iterations.size());
    result.converged = summary.termination_type == ceres::CONVERGENCE;
    if (width <= kernel_width) break;
    constexpr double shrinking = 2;
    width = std::max(kernel_width, width / shrinking);
  }
  for (std::size_t i = held; i < nodes.size(); ++i) {
    result.poses[i].linear() = nodes[i].rotation.normalized().toRotationMatrix();
    result.poses[i].translation() = nodes[i].translation_m;
  }
  for (const PoseEdge& edge : edges) {
    result.edge_mahalanobis.push_back(mahalanobis_distance(edge, result.poses));
  }
  return result;
}

bool is_rejected(double mahalanobis_distance, double kernel_width) {
  return mahalanobis_distance > std::sqrt(3) * kernel_width;  // where the weight is 1/16
}

}  // namespace tofmap
