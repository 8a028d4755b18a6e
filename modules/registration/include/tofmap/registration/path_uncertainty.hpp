// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

/// The error that is to be expected of a pose.
struct ExpectedError {
  double rotation_rad = 0;  ///< root mean square angle
  double position_m = 0;    ///< root mean square distance
};

/// The errors that are to be expected of the poses of a graph, by the covariances of its edges,
/// when the path is aligned with the truth as a whole: by the rigid motion that fits the positions
/// best. Errors add up along the path, and rotations move all that comes after them; loops reduce
/// both.
///
/// The poses are those at which the graph was optimised, and all edges count, so that edges which
/// are not relied on must be left out. Poses that no edges connect may be anywhere within a hundred
/// metres. The errors are means over random ones, and exact to about 5 %; the same graph always
/// gives the same values. Throws UsageError as check_edges() does.
std::vector<ExpectedError> expected_errors(std::span<const Pose> poses,
                                           std::span<const PoseEdge> edges);

/// The covariances of the errors of poses, by the covariances of the edges, if the first `held` of
/// them are exact: rotation vector, radians, then translation, metres, both along the axes of the
/// world. One for each of the other poses, in order. What expected_errors() says of poses and edges
/// holds here as well. Throws UsageError as check_edges() does.
std::vector<Eigen::Matrix<double, 6, 6>> covariances_beside(std::span<const Pose> poses,
                                                            std::span<const PoseEdge> edges,
                                                            std::size_t held);

}  // namespace tofmap
