// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// A pose found by PCL.
struct PclAlignment {
  Pose target_from_source = Pose::Identity();
  bool converged = false;  ///< as PCL says, which counts its iteration limit as convergence
};

/// Runs PCL's point-to-point ICP, or generalised ICP if `generalised` is true, with PCL's default
/// options.
PclAlignment align_with_pcl(const std::vector<Eigen::Vector3f>& source_m,
                            const std::vector<Eigen::Vector3f>& target_m,
                            const Pose& target_from_source, double max_distance_m, bool generalised,
                            int max_iterations);

}  // namespace tofmap
