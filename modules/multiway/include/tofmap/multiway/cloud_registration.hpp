// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/cloud_icp.hpp>

namespace tofmap {

struct CloudRegistrationOptions {
  double voxel_m = 0;
  std::string method = "generalised";
  double min_overlap = 0.15;
  double min_inlier_ratio = 0.6;
  double min_direction_share = 0.004;
  double kernel_width = 3;
  bool convert_units = false;

  static std::vector<OptionField<CloudRegistrationOptions>> fields();
};

enum class PairVerdict {
  registered,
  few_matches,   ///< no pose that several features agree on
  low_overlap,   ///< too small a share of either cloud lies near the other
  low_inliers,   ///< what lies near does not lie on the surface
  contradicted,  ///< one's sensor looked through the surfaces of the other
  degenerate,    ///< surfaces leave a direction free, as those of one wall
  ambiguous,     ///< another pose is nearly as good
  disagrees,     ///< other pairs contradict it
};

const char* verdict_name(PairVerdict verdict);

/// What became of the attempt to lay one cloud onto another.
struct CloudPair {
  int source = 0;
  int target = 0;
  PairVerdict verdict = PairVerdict::few_matches;
  Pose target_from_source = Pose::Identity();  ///< between the files' frames, metres
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int matches = 0;  ///< features that look alike
  int support = 0;  ///< those of them that agree on the pose
  CloudFit fit;     ///< of the cloud that overlaps more
  double free_space_violation =
      0;                       ///< share that contradicts what the other's sensor looked through
  double runner_up = 0;        ///< quality of the next best pose over that of this one
  double direction_share = 0;  ///< of the direction that is constrained least
  double mahalanobis_distance = 0;  ///< of the pair from the poses that all pairs together give
};

/// Where a cloud lies.
struct RegisteredCloud {
  bool is_registered = false;
  Pose common_from_cloud = Pose::Identity();  ///< meaningful only if registered
  double unit_m = 1;         ///< length of the cloud's unit, metres: its points are scaled by that
  std::string remark;        ///< why it is not registered, or what is odd about it; empty: nothing
  double inlier_ratio = 0;   ///< of the pair with most inliers
  double rmse_m = 0;         ///< of that pair
  std::vector<int> tied_to;  ///< clouds that it was registered with
};

struct CloudRegistration {
  double voxel_m = 0;
  std::vector<RegisteredCloud> clouds;  ///< in the order given
  std::vector<CloudPair> pairs;         ///< all that were tried, ordered by source, then target
  bool interrupted = false;

  int registered() const;
};

/// Places clouds of one scene in a common frame, which is that of the first one registered: no
/// order, no start poses.
///
/// Every two clouds are aligned by features and refined from coarse to fine; pairs that pass their
/// tests are edges of a graph, whose largest connected part is fitted as a whole (robustly: pairs
/// that others contradict lose their say). Clouds outside of it are not registered. A cloud whose
/// size differs from the others' by about the ratio of two units of length is tried with that unit,
/// and the remark says so; it is registered only with `convert_units`.
///
/// `keep_going` is shown the pairs done and to do; false ends the run. The result is the same for
/// any number of threads. `names` are what remarks call the clouds. Throws UsageError for fewer
/// than two clouds.
CloudRegistration register_clouds(std::span<const PointSet> clouds,
                                  std::span<const std::string> names,
                                  const CloudRegistrationOptions& options,
                                  const std::function<bool(int done, int all)>& keep_going = {});

}  // namespace tofmap
