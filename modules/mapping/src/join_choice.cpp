// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_choice.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/loop_fit.hpp"
#include "tofmap/mapping/place_recognition.hpp"

#include <algorithm>
#include <vector>

namespace tofmap {
namespace {

/// By how much the share of violations at another place must be larger.
constexpr double least_difference = 0.02;

/// Number of keyframes that make a runner-up.
constexpr std::size_t least_of_runner_up = 2;

class JoinSearch {
 public:
  JoinSearch(int map, std::span<const Keyframe> keyframes, const CameraModel& camera,
             const KeyframeSpacing& spacing, const LoopOptions& options)
      : map_(map), keyframes_(keyframes), camera_(camera), spacing_(spacing), options_(options) {
    for (const Keyframe& keyframe : keyframes) {
      if (keyframe.map == map) own_.push_back(&keyframe);
    }
  }

  std::vector<MapJoin> runners_up(const MapJoin& join,
                                  std::span<const PoseEdge> recognitions) const;
  double violations_at(const MapJoin& join) const;

 private:
  const Keyframe& at(int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  bool is_at(const PoseEdge& edge, const MapJoin& join) const;

  int map_;
  std::span<const Keyframe> keyframes_;
  const CameraModel& camera_;
  const KeyframeSpacing& spacing_;
  const LoopOptions& options_;
  std::vector<const Keyframe*> own_;  ///< those of the map
};

/// Whether a recognition puts its keyframe about where a join does.
bool JoinSearch::is_at(const PoseEdge& edge, const MapJoin& join) const {
  return at(edge.from).map == join.into &&
         are_near(at(edge.from).world_from_camera * edge.from_from_to,
                  join.into_from_map * at(edge.to).world_from_camera, recognition_reach_m,
                  recognition_reach_rad);
}

/// Other places that keyframes agree on.
std::vector<MapJoin> JoinSearch::runners_up(const MapJoin& join,
                                            std::span<const PoseEdge> recognitions) const {
  std::vector<const PoseEdge*> edges;
  for (const PoseEdge& edge : recognitions) {
    if (at(edge.to).map == map_ && !is_at(edge, join)) edges.push_back(&edge);
  }
  std::vector<MapJoin> runners_up;
  while (edges.size() >= least_of_runner_up) {
    const auto agreeing = most_that_agree(edges, keyframes_, options_);
    if (recognising_keyframes(agreeing) < least_of_runner_up) break;
    runners_up.push_back(join_by(agreeing, map_, keyframes_));
    std::erase_if(edges, [&](const PoseEdge* edge) {
      return is_at(*edge, runners_up.back()) || std::ranges::count(agreeing, edge) > 0;
    });
  }
  return runners_up;
}

/// The mean share of free-space violations of the keyframes at a place. 1 if they see nothing there
/// that was seen before.
double JoinSearch::violations_at(const MapJoin& join) const {
  constexpr std::size_t most_compared = 20;
  const std::size_t step = 1 + (own_.size() - 1) / most_compared;
  double sum = 0;
  int compared = 0;
  for (std::size_t i = 0; i < own_.size(); i += step) {
    const Pose pose = join.into_from_map * own_[i]->world_from_camera;
    const Keyframe* other = nearest_view(pose, keyframes_, spacing_,
                                         [&](const Keyframe& one) { return one.map == join.into; });
    if (other == nullptr) continue;
    const auto cloud = own_[i]->cloud.load();
    sum += free_space_violation_share({cloud.get(), pose}, target_of(*other), camera_,
                                      tolerated_pose_error_m);
    ++compared;
  }
  return compared > 0 ? sum / compared : 1;
}

}  // namespace

const Keyframe* nearest_view(const Pose& pose, std::span<const Keyframe> keyframes,
                             const KeyframeSpacing& spacing,
                             const std::function<bool(const Keyframe&)>& counts) {
  const Keyframe* nearest = nullptr;
  double least_steps = steps_of_same_view;
  for (const Keyframe& keyframe : keyframes) {
    if (!counts(keyframe)) continue;
    const double steps = spacing.between(keyframe.world_from_camera, pose);
    if (steps >= least_steps) continue;
    nearest = &keyframe;
    least_steps = steps;
  }
  return nearest;
}

bool is_certain(const MapJoin& join, std::span<const PoseEdge> recognitions,
                const std::function<bool(const MapJoin&)>& is_possible,
                std::span<const Keyframe> keyframes, const CameraModel& camera,
                const KeyframeSpacing& spacing, const LoopOptions& options) {
  const JoinSearch search(join.map, keyframes, camera, spacing, options);
  const double violations = search.violations_at(join);
  if (violations >= most_violations_since) return false;
  return std::ranges::none_of(search.runners_up(join, recognitions), [&](const MapJoin& runner_up) {
    return is_possible(runner_up) &&
           search.violations_at(runner_up) < violations + least_difference;
  });
}

}  // namespace tofmap
