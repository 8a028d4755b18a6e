// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Maps recordings with ground truth, and compares the errors of the edges between keyframes with
// their covariances:
//
//     bench_edge_errors SEQUENCE...
//
// For each recording it prints normalised errors: of single edges of odometry, of chains of ten of
// them one after the other, and of loops. If covariances are right, the mean of eᵀ Σ⁻¹ e / 6 is 1,
// and 95 % of the errors along the most uncertain direction are within 1.96 standard deviations.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <tofmap/acquisition/sequence.hpp>
#include <tofmap/pipeline/pipeline.hpp>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr int chain_length = 10;

/// Normalised errors of measured relative poses.
struct Errors {
  std::vector<double> mean_squares;   ///< eᵀ Σ⁻¹ e / 6
  std::vector<double> along_weakest;  ///< magnitude, in standard deviations
  std::vector<double> weakest_m;      ///< standard deviation of translation in that direction
  std::vector<double> error_m;        ///< error of translation
};

void add(const PoseEdge& edge, const Pose& true_from_from_to, Errors& errors) {
  const Pose difference = edge.from_from_to * true_from_from_to.inverse();
  const Eigen::AngleAxisd rotation(difference.linear());
  Vector6d error;
  error << rotation.angle() * rotation.axis(),
      edge.from_from_to.translation() - true_from_from_to.translation();
  errors.mean_squares.push_back(error.dot(edge.covariance.llt().solve(error)) / 6);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(
      Eigen::Matrix3d(edge.covariance.bottomRightCorner<3, 3>()));
  const double sigma_m = std::sqrt(solver.eigenvalues()(2));
  errors.weakest_m.push_back(sigma_m);
  errors.along_weakest.push_back(std::abs(solver.eigenvectors().col(2).dot(error.tail<3>())) /
                                 sigma_m);
  errors.error_m.push_back(error.tail<3>().norm());
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

void print(const char* name, const Errors& errors) {
  std::printf("  %-22s %5zu  %8.2f %8.2f  %8.2f  %8.1f %8.1f  %8.1f %8.1f\n", name,
              errors.mean_squares.size(), mean(errors.mean_squares),
              quantile(errors.mean_squares, 0.95), quantile(errors.along_weakest, 0.95),
              1e3 * quantile(errors.weakest_m, 0.5), 1e3 * quantile(errors.weakest_m, 0.95),
              1e3 * quantile(errors.error_m, 0.5), 1e3 * quantile(errors.error_m, 0.95));
}

/// An edge and the one before it, one after the other. The covariance of the second is turned into
/// the axes of the first, and an error of rotation of the first moves the end of the second.
PoseEdge chained(const PoseEdge& first, const PoseEdge& second) {
  PoseEdge edge{.from = first.from, .to = second.to};
  edge.from_from_to = first.from_from_to * second.from_from_to;
  const Eigen::Matrix3d rotation = first.from_from_to.linear();
  const Eigen::Vector3d arm = rotation * second.from_from_to.translation();
  Matrix6d of_first = Matrix6d::Identity();
  of_first.bottomLeftCorner<3, 3>() << 0, arm.z(), -arm.y(), -arm.z(), 0, arm.x(), arm.y(),
      -arm.x(), 0;
  edge.covariance =
      of_first * first.covariance * of_first.transpose() + rotated(second.covariance, rotation);
  return edge;
}

/// The measured motion over `chain_length` edges that ends at keyframe `id`, by the most certain
/// edge of each keyframe. Empty if there are fewer.
std::optional<PoseEdge> chain_to(int id, const std::vector<std::optional<PoseEdge>>& before) {
  std::optional<PoseEdge> chain = before[static_cast<std::size_t>(id)];
  for (int i = 1; i < chain_length && chain; ++i) {
    const auto& earlier = before[static_cast<std::size_t>(chain->from)];
    chain = earlier ? std::optional(chained(*earlier, *chain)) : std::nullopt;
  }
  return chain;
}

void measure(const std::filesystem::path& path, const PipelineOptions& options) {
  SequenceReader sequence(path);
  MapRun run(sequence.sensor(), options);
  run.advance(sequence);
  const Trajectory truth = read_trajectory(path / "groundtruth.txt");
  const auto keyframes = run.mapper().content().keyframes.all();
  const auto true_pose = [&](int id) {
    return pose_at(truth, keyframes[static_cast<std::size_t>(id)].timestamp_s);
  };
  const auto add_if_known = [&](const PoseEdge& edge, Errors& errors) {
    const auto from = true_pose(edge.from);
    const auto to = true_pose(edge.to);
    if (from && to) add(edge, from->inverse() * *to, errors);
  };
  Errors single;
  Errors loops;
  std::vector<std::optional<PoseEdge>> before(keyframes.size());
  for (const PoseEdge& edge : run.mapper().content().edges) {
    add_if_known(edge, edge.may_be_wrong ? loops : single);
    auto& best = before[static_cast<std::size_t>(edge.to)];
    if (edge.may_be_wrong) continue;
    if (!best || edge.covariance.trace() < best->covariance.trace()) best = edge;
  }
  Errors chains;
  for (int id = 0; id < static_cast<int>(keyframes.size()); ++id) {
    if (const auto chain = chain_to(id, before)) add_if_known(*chain, chains);
  }
  std::printf("%s\n", path.filename().c_str());
  print("edges of odometry", single);
  print("chains of ten", chains);
  print("loops", loops);
  std::fflush(stdout);
}

}  // namespace
}  // namespace tofmap

int main(int argc, char** argv) {
  try {
    std::printf("%-24s %5s  %8s %8s  %8s  %17s  %17s\n", "normalised errors", "count", "mean sq",
                "95 %", "weakest", "sigma mm 50, 95 %", "error mm 50, 95 %");
    for (int i = 1; i < argc; ++i) tofmap::measure(argv[i], {});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_edge_errors: %s\n", error.what());
    return 1;
  }
  return 0;
}
