// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/registration/oriented_cloud.hpp"

#include "pcl_points.hpp"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/kdtree/kdtree_flann.h>

namespace tofmap {
namespace {

constexpr int normal_neighbours = 20;

}  // namespace

struct PointSearch::Tree {
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
};

PointSearch::PointSearch(const std::vector<Eigen::Vector3f>& points_m) {
  auto tree = std::make_shared<Tree>();
  tree->tree.setInputCloud(pcl_points(points_m));
  tree_ = std::move(tree);
}

std::optional<PointSearch::Neighbour> PointSearch::nearest(const Eigen::Vector3f& place_m,
                                                           double max_distance_m) const {
  thread_local pcl::Indices indices;
  thread_local std::vector<float> squared_gaps_m2;
  constexpr unsigned just_one = 1;
  const int found = tree_->tree.radiusSearch({place_m.x(), place_m.y(), place_m.z()},
                                             max_distance_m, indices, squared_gaps_m2, just_one);
  if (found == 0) return std::nullopt;
  return Neighbour{static_cast<std::size_t>(indices[0]), squared_gaps_m2[0]};
}

std::optional<OrientedCloud> orient(std::span<const Eigen::Vector3d> points_m, double voxel_m,
                                    const Eigen::Vector3d& viewpoint_m) {
  std::vector<Eigen::Vector3f> points;
  points.reserve(points_m.size());
  for (const Eigen::Vector3d& point : points_m) points.push_back(point.cast<float>());
  const auto cloud = pcl_points(points);
  pcl::PointCloud<pcl::Normal> normals;
  if (points_m.size() >= least_oriented_points) {
    pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation;
    estimation.setInputCloud(cloud);
    estimation.setKSearch(normal_neighbours);
    const Eigen::Vector3f from = viewpoint_m.cast<float>();
    estimation.setViewPoint(from.x(), from.y(), from.z());
    estimation.compute(normals);
  }
  std::vector<Eigen::Vector3f> kept_points;
  std::vector<Eigen::Vector3f> kept_normals;
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const Eigen::Vector3f normal = normals[i].getNormalVector3fMap();
    if (!normal.allFinite() || normal.squaredNorm() < 0.5F) continue;
    kept_points.push_back(points[i]);
    kept_normals.push_back(normal);
  }
  if (kept_points.size() < least_oriented_points) return std::nullopt;
  const PointSearch search(kept_points);
  return OrientedCloud{std::move(kept_points), std::move(kept_normals), voxel_m, search};
}

}  // namespace tofmap
