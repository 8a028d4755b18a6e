// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_choice.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/loop_fit.hpp"
#include "tofmap/mapping/place_recognition.hpp"

#include <algorithm>
#include <set>
#include <vector>

namespace tofmap {
namespace {

/// By how much the share of violations at another place must be larger.
constexpr double least_difference = 0.02;

/// Errors of the poses of both maps that are tolerated in the comparison.
constexpr double pose_error_m = 0.03;

/// Number of keyframes that make a rival.
constexpr std::size_t least_of_rival = 2;

class JoinSearch {
 public:
  JoinSearch(int map, std::span<const Keyframe> keyframes, const CameraModel& camera,
             const KeyframeSpacing& spacing, const LoopOptions& options)
      : map_(map), keyframes_(keyframes), camera_(camera), spacing_(spacing), options_(options) {
    for (const Keyframe& keyframe : keyframes) {
      if (keyframe.map == map) own_.push_back(&keyframe);
    }
  }

  std::vector<MapJoin> rivals(const MapJoin& join, std::span<const PoseEdge> recognitions) const;
  double violations_at(const MapJoin& join) const;

 private:
  const Keyframe& at(int id) const { return keyframes_[static_cast<std::size_t>(id)]; }
  Pose into_from_map(const PoseEdge& edge) const;
  bool is_at(const PoseEdge& edge, const MapJoin& join) const;
  const Keyframe* nearest(const Pose& pose, int map) const;

  int map_;
  std::span<const Keyframe> keyframes_;
  const CameraModel& camera_;
  const KeyframeSpacing& spacing_;
  const LoopOptions& options_;
  std::vector<const Keyframe*> own_;  ///< those of the map
};

Pose JoinSearch::into_from_map(const PoseEdge& edge) const {
  return at(edge.from).world_from_camera * edge.from_from_to *
         at(edge.to).world_from_camera.inverse();
}

/// Whether a recognition puts its keyframe about where a join does.
bool JoinSearch::is_at(const PoseEdge& edge, const MapJoin& join) const {
  return at(edge.from).map == join.into &&
         are_near(at(edge.from).world_from_camera * edge.from_from_to,
                  join.into_from_map * at(edge.to).world_from_camera, recognition_reach_m,
                  recognition_reach_rad);
}

/// Other places that keyframes agree on.
std::vector<MapJoin> JoinSearch::rivals(const MapJoin& join,
                                        std::span<const PoseEdge> recognitions) const {
  std::vector<const PoseEdge*> edges;
  for (const PoseEdge& edge : recognitions) {
    if (at(edge.to).map == map_ && !is_at(edge, join)) edges.push_back(&edge);
  }
  std::vector<MapJoin> rivals;
  while (edges.size() >= least_of_rival) {
    const auto agreeing = most_that_agree(edges, keyframes_, options_);
    std::set<int> recognising;
    for (const PoseEdge* edge : agreeing) recognising.insert(edge->to);
    if (recognising.size() < least_of_rival) break;
    const PoseEdge& first = *agreeing.front();
    rivals.push_back({.into = at(first.from).map,
                      .map = map_,
                      .into_from_map = into_from_map(first),
                      .edges = {}});
    std::erase_if(edges, [&](const PoseEdge* edge) {
      return is_at(*edge, rivals.back()) || std::ranges::count(agreeing, edge) > 0;
    });
  }
  return rivals;
}

/// The keyframe of another map that sees mostly the same from a pose. Null if there is none.
const Keyframe* JoinSearch::nearest(const Pose& pose, int map) const {
  const Keyframe* nearest = nullptr;
  double least_steps = steps_of_same_view;
  for (const Keyframe& keyframe : keyframes_) {
    if (keyframe.map != map) continue;
    const double steps = spacing_.between(keyframe.world_from_camera, pose);
    if (steps >= least_steps) continue;
    nearest = &keyframe;
    least_steps = steps;
  }
  return nearest;
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
    const Keyframe* other = nearest(pose, join.into);
    if (other == nullptr) continue;
    const auto cloud = own_[i]->cloud.load();
    sum +=
        free_space_violation_share({cloud.get(), pose}, target_of(*other), camera_, pose_error_m);
    ++compared;
  }
  return compared > 0 ? sum / compared : 1;
}

}  // namespace

bool is_certain(const MapJoin& join, std::span<const PoseEdge> recognitions,
                const std::function<bool(const MapJoin&)>& is_possible,
                std::span<const Keyframe> keyframes, const CameraModel& camera,
                const KeyframeSpacing& spacing, const LoopOptions& options) {
  const JoinSearch search(join.map, keyframes, camera, spacing, options);
  const double violations = search.violations_at(join);
  if (violations >= most_violations_since) return false;
  return std::ranges::none_of(search.rivals(join, recognitions), [&](const MapJoin& rival) {
    return is_possible(rival) && search.violations_at(rival) < violations + least_difference;
  });
}

}  // namespace tofmap
