// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/loop_options.hpp"

#include <cmath>

namespace tofmap {
namespace {

/// Smallest standard deviations of the drift prior: registration corrects errors of this size.
constexpr double least_prior_m = 0.05;
constexpr double least_prior_rad = 0.03;

}  // namespace

std::vector<OptionField<LoopOptions>> LoopOptions::fields() {
  using O = LoopOptions;
  return {
      {"close", &O::close, 0, 1, "", "searches for loops and corrects the path with them"},
      {"radius_m", &O::radius_m, 0.1, 100, "m",
       "loops are searched for among keyframes at most this far away"},
      {"max_rotation_rad", &O::max_rotation_rad, 0.01, 3.2, "rad",
       "loops are searched for among keyframes that are rotated by at most this"},
      {"min_keyframes", &O::min_keyframes, 1, 100000, "",
       "smallest number of keyframes from one end of a loop to the other"},
      {"min_overlap", &O::min_overlap, 0.01, 1, "",
       "smallest share of a keyframe's points that must have a correspondence in earlier "
       "keyframes"},
      {"min_inlier_ratio", &O::min_inlier_ratio, 0, 1, "",
       "smallest share of the correspondences of a loop that must fit its pose"},
      {"drift_share", &O::drift_share, 0, 1, "",
       "standard deviation of the drift in position, as a share of the length of the path since "
       "the place was seen first"},
      {"kernel_width", &O::kernel_width, 0.5, 100, "",
       "width of the kernel that down-weights loop constraints with large errors, in standard "
       "deviations"},
  };
}

MotionPrior drift_prior(const Pose& expected, double path_m, const LoopOptions& options) {
  const double drift_m = options.drift_share * path_m;
  return {.world_from_camera = expected,
          .rotation_sigma_rad = std::hypot(least_prior_rad, drift_rad_per_drift_m * drift_m),
          .translation_sigma_m = std::hypot(least_prior_m, drift_m)};
}

}  // namespace tofmap
