// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/evaluation/map_score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/Eigenvalues>
#include <pcl/kdtree/impl/kdtree_flann.hpp>
#include <pcl/kdtree/kdtree_flann.h>

#include <tofmap/core/error.hpp>
#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;
using Tree = pcl::KdTreeFLANN<pcl::PointXYZ>;

constexpr double voxel_m = 0.04;
constexpr double near_m = 0.1;
constexpr double worst_m = 5;

std::int64_t voxel_key(const Eigen::Vector3d& point) {
  constexpr std::int64_t half = std::int64_t{1} << 20;
  std::int64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto cell = static_cast<std::int64_t>(std::floor(point[axis] / voxel_m));
    key = (key << 21) | (std::clamp(cell, -half, half - 1) + half);
  }
  return key;
}

/// The normal of the plane through the neighbours of a point within 12 cm, or within three
/// spacings if that is more; at most 24 of them.
Eigen::Vector3f plane_normal(const Cloud& cloud, const Tree& tree, int index, double spacing_m) {
  constexpr double radius_m = 0.12;
  constexpr double spacings = 3;
  constexpr unsigned max_neighbours = 24;
  std::vector<int> neighbours;
  std::vector<float> squares;
  tree.radiusSearch(cloud, index, std::max(radius_m, spacings * spacing_m), neighbours, squares,
                    max_neighbours);
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  for (const int i : neighbours) mean += cloud[i].getVector3fMap();
  mean /= static_cast<float>(neighbours.size());
  Eigen::Matrix3f scatter = Eigen::Matrix3f::Zero();
  for (const int i : neighbours) {
    const Eigen::Vector3f d = cloud[i].getVector3fMap() - mean;
    scatter += d * d.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f>(scatter).eigenvectors().col(0);
}

Tree make_tree(const Cloud::ConstPtr& cloud) {
  constexpr bool sorted = true;
  Tree tree(sorted);
  tree.setInputCloud(cloud);
  return tree;
}

struct Nearest {
  int index = 0;
  double gap_m = 0;
};

constexpr double anywhere_m = std::numeric_limits<double>::infinity();

/// The point of the tree that is nearest to `point`. If none is within `most_m`, the index is −1
/// and the distance `most_m`.
Nearest nearest(const Tree& tree, const pcl::PointXYZ& point, double most_m) {
  std::vector<int> index(1);
  std::vector<float> square(1);
  const int found = most_m < anywhere_m ? tree.radiusSearch(point, most_m, index, square, 1)
                                        : tree.nearestKSearch(point, 1, index, square);
  return found > 0 ? Nearest{index[0], std::sqrt(square[0])} : Nearest{-1, most_m};
}

/// The points of a frame that become points of a reference surface, in the camera's frame.
struct Samples {
  static constexpr Eigen::Index stride = 2;  ///< between samples in both directions, pixels

  const ImageF& range_m;
  const PixelRays& rays;

  bool is_seen(Eigen::Index v, Eigen::Index u) const {
    return v >= 0 && u >= 0 && v < range_m.rows() && u < range_m.cols() &&
           std::isfinite(range_m(v, u));
  }

  Eigen::Vector3d point_m(Eigen::Index v, Eigen::Index u) const {
    return double{range_m(v, u)} * Eigen::Vector3d(rays.x(v, u), rays.y(v, u), rays.z(v, u));
  }

  /// Distance from the sample at (v + dv, u + du) or the opposite one, whichever is nearer. Zero if
  /// neither lies on the same surface.
  double step_m(Eigen::Index v, Eigen::Index u, Eigen::Index dv, Eigen::Index du) const {
    constexpr double most_of_range = 0.25;  // a floor 15 m away, from 1.5 m above it
    double least_m = most_of_range * double{range_m(v, u)};
    const double most_m = least_m;
    for (const Eigen::Index sign : {-1, 1}) {
      const Eigen::Index v_next = v + sign * dv;
      const Eigen::Index u_next = u + sign * du;
      if (!is_seen(v_next, u_next)) continue;
      least_m = std::min(least_m, (point_m(v_next, u_next) - point_m(v, u)).norm());
    }
    return least_m < most_m ? least_m : 0;
  }

  double spacing_m(Eigen::Index v, Eigen::Index u) const {
    return std::max(step_m(v, u, stride, 0), step_m(v, u, 0, stride));
  }
};

/// A map and the reference surface, both relative to the origin of the reference.
struct Clouds {
  Clouds(const MapCloud& map, const Pose& truth_from_map, const ReferenceSurface& reference) {
    if (reference.points().empty()) throw UsageError("map score: the reference surface is empty");
    for (const Eigen::Vector3f& p : reference.points()) truth->push_back({p.x(), p.y(), p.z()});
    spacings_m = reference.spacings_m();
    const Pose origin_from_map = Eigen::Translation3d(-reference.origin_m()) * truth_from_map;
    for (const MapPoint& point : map.points) {
      const Eigen::Vector3f p =
          (origin_from_map * point.getVector3fMap().cast<double>()).cast<float>();
      registered->push_back({p.x(), p.y(), p.z()});
    }
  }

  Cloud::Ptr truth = std::make_shared<Cloud>();
  std::vector<float> spacings_m;  ///< of `truth`
  Cloud::Ptr registered = std::make_shared<Cloud>();
};

std::vector<float> errors_m(const Clouds& clouds, double most_m) {
  const Cloud& truth = *clouds.truth;
  const Tree truth_tree = make_tree(clouds.truth);
  const double reach_m = std::max(most_m, double{std::ranges::max(clouds.spacings_m)});
  std::vector<float> errors(clouds.registered->size());
#pragma omp parallel for schedule(dynamic, 256)
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const pcl::PointXYZ& point = (*clouds.registered)[i];
    const Nearest found = nearest(truth_tree, point, reach_m);
    double gap_m = found.gap_m;
    const double spacing_m =
        found.index >= 0 ? clouds.spacings_m[static_cast<std::size_t>(found.index)] : 0;
    if (found.index >= 0 && gap_m < std::max(near_m, spacing_m)) {
      const Eigen::Vector3f d = point.getVector3fMap() - truth[found.index].getVector3fMap();
      gap_m = std::abs(d.dot(plane_normal(truth, truth_tree, found.index, spacing_m)));
    }
    errors[i] = static_cast<float>(std::min(gap_m, most_m));
  }
  return errors;
}

}  // namespace

void ReferenceSurface::add(const ImageF& range_truth_m, const PixelRays& rays,
                           const Pose& world_from_camera) {
  const Samples samples{range_truth_m, rays};
  const Pose origin_from_camera = Eigen::Translation3d(-origin_m_) * world_from_camera;
  for (Eigen::Index v = 0; v < range_truth_m.rows(); v += Samples::stride) {
    for (Eigen::Index u = 0; u < range_truth_m.cols(); u += Samples::stride) {
      if (!samples.is_seen(v, u)) continue;
      const Eigen::Vector3d point = origin_from_camera * samples.point_m(v, u);
      if (voxels_.emplace(voxel_key(point), points_.size()).second) {
        points_.push_back(point.cast<float>());
        spacings_m_.push_back(static_cast<float>(samples.spacing_m(v, u)));
      }
    }
  }
}

Eigen::Vector3d origin_near(const Trajectory& poses) {
  Eigen::Vector3d origin_m = Eigen::Vector3d::Zero();
  if (poses.empty()) return origin_m;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const StampedPose& pose : poses)
      values.push_back(pose.world_from_camera.translation()[axis]);
    origin_m[axis] = std::round(median(values));
  }
  return origin_m;
}

std::vector<float> map_errors_m(const MapCloud& map, const Pose& truth_from_map,
                                const ReferenceSurface& reference, double most_m) {
  if (!(most_m > 0))
    throw UsageError("map errors: most_m must be above 0, and is " + std::to_string(most_m));
  const Clouds clouds(map, truth_from_map, reference);
  return errors_m(clouds, most_m);
}

MapScore score_map(const MapCloud& map, const Pose& truth_from_map,
                   const ReferenceSurface& reference) {
  const Clouds clouds(map, truth_from_map, reference);
  MapScore score;
  score.accuracy_m = std::numeric_limits<double>::quiet_NaN();
  if (map.empty()) return score;

  double sum = 0;
  int far = 0;
  score.errors_m = errors_m(clouds, anywhere_m);
  for (const double error_m : score.errors_m) {
    sum += std::min(error_m, worst_m);
    far += error_m > far_error_m ? 1 : 0;
  }
  const auto count = static_cast<double>(map.size());
  score.accuracy_m = sum / count;
  score.far_percent = 100.0 * far / count;

  const Tree map_tree = make_tree(clouds.registered);
  const Cloud& truth = *clouds.truth;
  int covered = 0;
#pragma omp parallel for schedule(dynamic, 256) reduction(+ : covered)
  for (std::size_t i = 0; i < truth.size(); ++i) {
    covered += nearest(map_tree, truth[i], near_m).gap_m < near_m ? 1 : 0;
  }
  score.completeness_percent = 100.0 * covered / static_cast<double>(truth.size());
  return score;
}

}  // namespace tofmap
