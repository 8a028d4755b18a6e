// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "pcl_alignment.hpp"

#include "pcl_points.hpp"

#include <pcl/registration/gicp.h>
#include <pcl/registration/icp.h>

namespace tofmap {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

template <class Icp>
PclAlignment run(Icp& icp, const Cloud::Ptr& source, const Cloud::Ptr& target, const Pose& initial,
                 double max_distance_m, int max_iterations) {
  icp.setInputSource(source);
  icp.setInputTarget(target);
  icp.setMaxCorrespondenceDistance(max_distance_m);
  icp.setMaximumIterations(max_iterations);
  Cloud aligned;
  icp.align(aligned, initial.matrix().cast<float>());
  PclAlignment out;
  out.target_from_source.matrix() = icp.getFinalTransformation().template cast<double>();
  // PCL computes in floats: the matrix must be made a rotation in double precision.
  const Eigen::Matrix3d linear = out.target_from_source.linear();
  out.target_from_source.linear() = Eigen::Quaterniond(linear).normalized().toRotationMatrix();
  out.converged = icp.hasConverged();
  return out;
}

}  // namespace

PclAlignment align_with_pcl(const std::vector<Eigen::Vector3f>& source_m,
                            const std::vector<Eigen::Vector3f>& target_m,
                            const Pose& target_from_source, double max_distance_m, bool generalised,
                            int max_iterations) {
  const Cloud::Ptr source = pcl_points(source_m);
  const Cloud::Ptr target = pcl_points(target_m);
  if (generalised) {
    pcl::GeneralizedIterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
    return run(icp, source, target, target_from_source, max_distance_m, max_iterations);
  }
  pcl::IterativeClosestPoint<pcl::PointXYZ, pcl::PointXYZ> icp;
  return run(icp, source, target, target_from_source, max_distance_m, max_iterations);
}

}  // namespace tofmap
