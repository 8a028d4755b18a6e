// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/relocalisation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <tofmap/core/median.hpp>

namespace tofmap {
namespace {

/// How far from a keyframe a camera may stand and look that is recognised by it.
constexpr double reach_m = 0.5;
constexpr double reach_rad = 0.35;

/// A registration from half a metre off needs more than one from the frame before.
constexpr int iterations = 40;
constexpr double point_gap_m = 1;

std::vector<RegistrationTarget> targets_around(int id, std::span<const Keyframe> keyframes) {
  std::vector<RegistrationTarget> targets;
  const int last = std::min(static_cast<int>(keyframes.size()) - 1, id + 1);
  for (int i = std::max(0, id - 1); i <= last; ++i) {
    targets.push_back(target_of(keyframes[static_cast<std::size_t>(i)]));
  }
  return targets;
}

/// Ids of keyframes, those that look most alike first.
std::vector<int> most_alike(const PlaceDescriptor& place,
                            std::span<const PlaceDescriptor> descriptors) {
  constexpr std::size_t most = 5;
  std::vector<double> differences;
  for (const PlaceDescriptor& other : descriptors) differences.push_back(place.difference(other));
  std::vector<int> ids(descriptors.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::ranges::stable_sort(ids, {},
                           [&](int id) { return differences[static_cast<std::size_t>(id)]; });
  ids.resize(std::min(ids.size(), most));
  return ids;
}

/// Share of the frame's points that agree with what is known of a place.
double support(const Relocalisation& place) {
  return place.registration.overlap * place.registration.inlier_share;
}

/// A place that another one has more than this share of the support of is not sure.
constexpr double sure_share = 0.9;

bool is_same_place(const Relocalisation& one, const Relocalisation& other) {
  const Pose& pose = one.registration.world_from_camera;
  const Pose& other_pose = other.registration.world_from_camera;
  return (pose.translation() - other_pose.translation()).norm() < reach_m / 2 &&
         rotation_angle_rad(pose, other_pose) < reach_rad / 2;
}

}  // namespace

PlaceDescriptor::PlaceDescriptor(const SurfaceCloud& cloud) {
  log_range_.fill(std::numeric_limits<float>::quiet_NaN());
  std::vector<float> ranges;
  for (std::size_t part = 0; part < log_range_.size(); ++part) {
    const std::size_t first_row = part / cols * cloud.height / rows;
    const std::size_t last_row = (part / cols + 1) * cloud.height / rows;
    const std::size_t first_col = part % cols * cloud.width / cols;
    const std::size_t last_col = (part % cols + 1) * cloud.width / cols;
    ranges.clear();
    for (std::size_t row = first_row; row < last_row; ++row) {
      for (std::size_t col = first_col; col < last_col; ++col) {
        const SurfacePoint& point = cloud.points[row * cloud.width + col];
        if (point.has_normal()) ranges.push_back(point.getVector3fMap().norm());
      }
    }
    const std::size_t pixels = (last_row - first_row) * (last_col - first_col);
    if (ranges.empty() || 2 * ranges.size() < pixels) continue;
    log_range_[part] = std::log(median(ranges));
  }
}

double PlaceDescriptor::difference(const PlaceDescriptor& other) const {
  double sum = 0;
  std::size_t shared = 0;
  for (std::size_t i = 0; i < log_range_.size(); ++i) {
    const float off = std::abs(log_range_[i] - other.log_range_[i]);
    if (std::isnan(off)) continue;
    sum += off;
    ++shared;
  }
  if (2 * shared < log_range_.size()) return std::numeric_limits<double>::infinity();
  return sum / static_cast<double>(shared);
}

std::optional<Relocalisation> relocalise(const SurfaceCloud& cloud,
                                         std::span<const Keyframe> keyframes,
                                         std::span<const PlaceDescriptor> descriptors,
                                         const CameraModel& camera, const LoopOptions& options,
                                         const RegistrationOptions& registration) {
  RegistrationOptions wide = registration;
  wide.max_iterations = std::max(iterations, registration.max_iterations);
  wide.max_point_gap_m = std::max(point_gap_m, registration.max_point_gap_m);
  std::vector<Relocalisation> found;
  for (const int id : most_alike(PlaceDescriptor(cloud), descriptors)) {
    const auto targets = targets_around(id, keyframes);
    MotionPrior prior{
        .world_from_camera = keyframes[static_cast<std::size_t>(id)].world_from_camera,
        .rotation_sigma_rad = reach_rad,
        .translation_sigma_m = reach_m};
    // First from afar; what that finds, as closely as frames are registered.
    prior.world_from_camera =
        register_to_targets(cloud, targets, camera, prior, wide).world_from_camera;
    const RegistrationResult result =
        register_to_targets(cloud, targets, camera, prior, registration);
    if (is_verified(result, options)) found.push_back({id, result});
  }
  if (found.empty()) return std::nullopt;
  std::ranges::stable_sort(found, std::ranges::greater(), support);
  const Relocalisation& best = found.front();
  const bool is_ambiguous = std::ranges::any_of(found, [&](const Relocalisation& other) {
    return support(other) > sure_share * support(best) && !is_same_place(best, other);
  });
  return is_ambiguous ? std::nullopt : std::optional(best);
}

}  // namespace tofmap
