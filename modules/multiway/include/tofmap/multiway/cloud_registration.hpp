// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <tofmap/cloud/point_file.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/multiway/cloud_sensor.hpp>
#include <tofmap/registration/cloud_icp.hpp>

namespace tofmap {

/// Options of register_clouds().
struct CloudRegistrationOptions {
  /// Edge length of the voxels of the coarsest level, where features are matched, 0 … 1000 m. 0
  /// chooses it so that about 5000 points per cloud remain. Finer levels have half and a quarter of
  /// it.
  double voxel_m = 0;
  /// How poses are refined.
  CloudMethod method = CloudMethod::generalised;
  /// Whether the origin of each cloud is the position of its sensor. If so, the cloud tells which
  /// space is free, and the other clouds are tested against that.
  SensorAtOrigin sensor_at_origin = SensorAtOrigin::infer;
  /// Smallest share of one of two clouds that must be near the other, 0 … 1.
  double min_overlap = 0.15;
  /// Smallest share of the near points that must lie on the surface of the other cloud, 0 … 1, for
  /// complete overlap. The limit rises by up to 0.15 as the overlap decreases.
  double min_inlier_ratio = 0.6;
  /// Smallest share of the observations that must constrain each direction of motion, 0 … 1. Pairs
  /// below it are degenerate.
  double min_direction_share = 0.004;
  /// Width of the kernel of the pose graph in standard deviations of a pair, 0.5 … 100. Pairs that
  /// contradict others are down-weighted, and rejected if their error is more than √3 times that.
  double kernel_width = 3;
  /// Whether a cloud that is in another unit of length than the others is scaled to theirs and
  /// registered. If not, it is left out with a remark.
  bool convert_units = false;

  static std::vector<OptionField<CloudRegistrationOptions>> fields();
};

/// Whether two clouds could be registered with each other, and if not, the first test that failed.
enum class PairVerdict {
  registered,    ///< the pair passed all tests
  few_matches,   ///< fewer than 15 feature matches agree on a pose
  low_overlap,   ///< less than `min_overlap` of either cloud is near the other
  low_inliers,   ///< too few of the near points lie on the surface of the other cloud
  contradicted,  ///< free-space violations: one sensor saw through the surfaces of the other cloud
  degenerate,    ///< the surfaces leave a direction of motion unconstrained, as a single wall does
  ambiguous,     ///< another pose is nearly as good
  disagrees,     ///< the pair contradicts the other pairs
};

std::span<const NamedValue<PairVerdict>> named_values(PairVerdict);

/// Result of registering one cloud with another.
struct CloudPair {
  int source = 0;  ///< index of a cloud
  int target = 0;  ///< index of the other cloud
  PairVerdict verdict = PairVerdict::few_matches;
  Pose target_from_source = Pose::Identity();  ///< between the frames of both clouds, metres
  /// CloudIcpResult::covariance of `target_from_source`.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  int matches = 0;                  ///< number of feature matches
  int support = 0;                  ///< number of matches that agree on the pose
  CloudFit fit;                     ///< of whichever cloud overlaps the other more
  int tested_views = 0;             ///< number of places from which free space was tested
  double free_space_violation = 0;  ///< larger share of free-space violations of either cloud
  double window_share = 0;          ///< the same for what may be seen through windows
  double runner_up = 0;             ///< quality of the second best pose divided by that of this one
  double direction_share = 0;       ///< share of the direction that is constrained least
  double mahalanobis_distance = 0;  ///< of the pair at the poses of the fit over all pairs
};

/// The pose of one cloud in the common frame.
struct RegisteredCloud {
  bool is_registered = false;
  Pose common_from_cloud = Pose::Identity();  ///< meaningful only if registered
  CloudSensor sensor;        ///< how it was found, and where, in the frame and unit of the cloud
  double unit_m = 1;         ///< unit of length of the cloud, metres; its points are scaled by it
  std::string remark;        ///< why it is not registered, or what is unusual; empty if nothing is
  double inlier_ratio = 0;   ///< largest one of its registered pairs
  double rmse_m = 0;         ///< CloudFit::rmse_m of that pair
  std::vector<int> tied_to;  ///< indices of the clouds that it was registered with
};

/// Result of register_clouds().
struct CloudRegistration {
  double voxel_m = 0;                   ///< edge length of the voxels of the coarsest level
  std::vector<RegisteredCloud> clouds;  ///< in the order given
  std::vector<CloudPair> pairs;         ///< all pairs that were tried, by source, then target
  bool interrupted = false;             ///< whether `keep_going` ended the run

  /// Number of registered clouds.
  int registered() const;
};

/// Registers clouds of one scene in a common frame, that of the first registered cloud. Needs
/// neither initial poses nor an order of the clouds.
///
/// Each pair of clouds is aligned by features (guess_alignments()) and refined by ICP from coarse
/// to fine (align_clouds()). Pairs that pass the tests of PairVerdict are edges of a pose graph
/// (optimise_pose_graph()), in which pairs that contradict others are down-weighted. Clouds outside
/// the largest connected part of the graph are not registered. A cloud whose size differs from that
/// of the others by about the ratio of two units of length is tried with that unit; the remark of
/// the cloud names the unit if the cloud then fits, but the cloud is registered only with
/// `convert_units`.
///
/// `keep_going` is called with the numbers of pairs done and of all pairs; if it returns false, the
/// run ends. `names` are the names of the clouds in remarks. The result is the same for any number
/// of threads. Throws UsageError for fewer than two clouds, if the numbers of clouds and names
/// differ, or if `voxel_m` is too small for the clouds.
CloudRegistration register_clouds(std::span<const PointSet> clouds,
                                  std::span<const std::string> names,
                                  const CloudRegistrationOptions& options,
                                  const std::function<bool(int done, int all)>& keep_going = {});

}  // namespace tofmap
