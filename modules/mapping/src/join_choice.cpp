// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/join_choice.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/loop_fit.hpp"
#include "tofmap/mapping/place_recognition.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace tofmap {
namespace {

/// Largest share of violations at the place of a join. It is more than furniture that was moved
/// causes (up to 0.14), and less than places that look alike in some views.
constexpr double most_violations_of_join = 0.2;

/// By how much the share of violations at another place must be larger, as a difference and as a
/// ratio: at places with many changes, it varies more.
constexpr double least_difference = 0.02;
constexpr double least_ratio = 1.5;

/// Number of keyframes that must agree on a place for it to be tried, or to be a runner-up.
constexpr std::size_t least_of_place = 2;

class JoinSearch {
 public:
  JoinSearch(int map, const JoinContext& context) : map_(map), context_(context) {
    for (const Keyframe& keyframe : context.keyframes) {
      if (keyframe.map == map) own_.push_back(&keyframe);
    }
  }

  std::vector<MapJoin> places(std::span<const PoseEdge> recognitions,
                              const MapJoin* but = nullptr) const;
  std::vector<double> violations_at(const MapJoin& join) const;
  std::optional<MapJoin> confirmed(const MapJoin& join, std::size_t least_agreeing) const;
  std::size_t fitting(const MapJoin& join) const;
  bool are_same(const MapJoin& one, const MapJoin& other) const;

 private:
  std::vector<const Keyframe*> some_of_own() const;
  const Keyframe& at(int id) const { return context_.keyframes[static_cast<std::size_t>(id)]; }
  bool is_at(const PoseEdge& edge, const MapJoin& join) const;
  const Keyframe* nearest_of_others(const Pose& pose, const MapJoin& join) const;
  std::optional<PoseEdge> registered(const Keyframe& keyframe, const MapJoin& join) const;

  int map_;
  const JoinContext& context_;
  std::vector<const Keyframe*> own_;  ///< those of the map
};

/// Whether a recognition puts its keyframe about where a join does.
bool JoinSearch::is_at(const PoseEdge& edge, const MapJoin& join) const {
  return at(edge.from).map == join.into &&
         are_near(at(edge.from).world_from_camera * edge.from_from_to,
                  join.into_from_map * at(edge.to).world_from_camera, recognition_reach_m,
                  recognition_reach_rad);
}

/// Whether two joins put the map about there as well.
bool JoinSearch::are_same(const MapJoin& one, const MapJoin& other) const {
  const Pose& first = own_.front()->world_from_camera;
  return one.into == other.into && are_near(one.into_from_map * first, other.into_from_map * first,
                                            recognition_reach_m, recognition_reach_rad);
}

/// The places that keyframes agree on, those of most recognitions first; without that of a join, if
/// one is given.
std::vector<MapJoin> JoinSearch::places(std::span<const PoseEdge> recognitions,
                                        const MapJoin* but) const {
  std::vector<const PoseEdge*> edges;
  for (const PoseEdge& edge : recognitions) {
    const bool is_of_another = at(edge.to).map == map_ && at(edge.from).map != map_;
    const bool is_left_out = but != nullptr && is_at(edge, *but);
    if (is_of_another && !is_left_out) edges.push_back(&edge);
  }
  std::vector<MapJoin> places;
  while (edges.size() >= least_of_place) {
    const auto agreeing = most_that_agree(edges, context_.keyframes, context_.loops);
    const MapJoin place = join_by(agreeing, map_, context_.keyframes);
    std::erase_if(edges, [&](const PoseEdge* edge) {
      return is_at(*edge, place) || std::ranges::count(agreeing, edge) > 0;
    });
    // A keyframe may recognise one place by several others.
    if (recognising_keyframes(agreeing) >= least_of_place) places.push_back(place);
  }
  return places;
}

const Keyframe* JoinSearch::nearest_of_others(const Pose& pose, const MapJoin& join) const {
  return nearest_view(pose, context_.keyframes, context_.spacing,
                      [&](const Keyframe& one) { return one.map == join.into; });
}

/// Registers a keyframe from where a join puts it. Empty if it does not fit there.
std::optional<PoseEdge> JoinSearch::registered(const Keyframe& keyframe,
                                               const MapJoin& join) const {
  const MotionPrior prior{.world_from_camera = join.into_from_map * keyframe.world_from_camera,
                          .rotation_sigma_rad = recognition_reach_rad / 4,
                          .translation_sigma_m = recognition_reach_m / 4};
  const Keyframe* other = nearest_of_others(prior.world_from_camera, join);
  if (other == nullptr) return std::nullopt;
  const auto cloud = keyframe.cloud.load();
  const RegistrationResult result =
      register_to_targets(*cloud, targets_around(*other, context_.keyframes), context_.camera,
                          prior, context_.registration);
  // The join tells what a flat surface does not constrain.
  const bool fits = result.status == RegistrationStatus::converged &&
                    result.overlap >= context_.loops.min_overlap &&
                    result.inlier_ratio >= context_.loops.min_inlier_ratio;
  if (!fits || contradicts_free_space({cloud.get(), result.world_from_camera}, target_of(*other),
                                      context_.camera, most_violations_since)) {
    return std::nullopt;
  }
  return loop_edge(*other, keyframe.id, result);
}

/// The join with the other keyframes of the map that confirm it. Empty if they are too few.
std::optional<MapJoin> JoinSearch::confirmed(const MapJoin& join,
                                             std::size_t least_agreeing) const {
  std::vector<PoseEdge> edges = join.edges;
  for (const Keyframe* keyframe : own_) {
    if (std::ranges::count(join.edges, keyframe->id, &PoseEdge::to) > 0) continue;
    if (const auto edge = registered(*keyframe, join)) edges.push_back(*edge);
  }
  const auto agreeing = most_that_agree(pointers_to(edges), context_.keyframes, context_.loops);
  if (recognising_keyframes(agreeing) < least_agreeing) return std::nullopt;
  return join_by(agreeing, map_, context_.keyframes);
}

/// Keyframes of the map, all along it, that stand for the others.
std::vector<const Keyframe*> JoinSearch::some_of_own() const {
  constexpr std::size_t most = 20;
  const std::size_t step = 1 + (own_.size() - 1) / most;
  std::vector<const Keyframe*> some;
  for (std::size_t i = 0; i < own_.size(); i += step) some.push_back(own_[i]);
  return some;
}

/// Number of some keyframes of the map that fit at a place.
std::size_t JoinSearch::fitting(const MapJoin& join) const {
  std::size_t count = 0;
  for (const Keyframe* keyframe : some_of_own()) count += registered(*keyframe, join) ? 1 : 0;
  return count;
}

/// The shares of free-space violations of the keyframes at a place, the least first. Empty if they
/// see nothing there that was seen before.
std::vector<double> JoinSearch::violations_at(const MapJoin& join) const {
  std::vector<double> shares;
  for (const Keyframe* keyframe : some_of_own()) {
    const Pose pose = join.into_from_map * keyframe->world_from_camera;
    const Keyframe* other = nearest_of_others(pose, join);
    if (other == nullptr) continue;
    const auto cloud = keyframe->cloud.load();
    shares.push_back(free_space_violation_share({cloud.get(), pose}, target_of(*other),
                                                context_.camera, tolerated_pose_error_m));
  }
  std::ranges::sort(shares);
  return shares;
}

double mean_of(std::span<const double> shares) {
  if (shares.empty()) return 1;
  return std::reduce(shares.begin(), shares.end()) / static_cast<double>(shares.size());
}

/// The mean of the less half of shares: what was moved since is in sight of some keyframes, a place
/// that looks alike contradicts all of them.
double mean_of_half(std::span<const double> shares) {
  return mean_of(shares.first((shares.size() + 1) / 2));
}

/// Whether keyframes contradict a place clearly less than another one, by mean_of_half().
bool is_clearly_less(double contradicted, double other) {
  return other >= std::max(contradicted + least_difference, contradicted * least_ratio);
}

/// None if keyframes contradict the place of a join little, and all others clearly more.
JoinObstacle obstacle_of(const MapJoin& join, std::span<const PoseEdge> possible,
                         const IsPossibleJoin& is_possible, const JoinContext& context) {
  const JoinSearch search(join.map, context);
  const std::vector<double> violations = search.violations_at(join);
  if (mean_of(violations) >= most_violations_of_join) return JoinObstacle::contradicted;
  const double half = mean_of_half(violations);
  const auto runners_up = search.places(possible, &join);
  const bool is_ambiguous = std::ranges::any_of(runners_up, [&](const MapJoin& runner_up) {
    return is_possible(runner_up) &&
           !is_clearly_less(half, mean_of_half(search.violations_at(runner_up)));
  });
  return is_ambiguous ? JoinObstacle::ambiguous : JoinObstacle::none;
}

/// find_certain_join() with another number of keyframes that must agree.
std::optional<MapJoin> certain_join(int map, std::span<const PoseEdge> possible,
                                    const IsPossibleJoin& is_possible, const JoinContext& context,
                                    std::size_t least_agreeing) {
  const JoinSearch search(map, context);
  for (const MapJoin& place : search.places(possible)) {
    if (!is_possible(place)) continue;
    auto join = search.confirmed(place, least_agreeing);
    if (!join) continue;
    if (obstacle_of(*join, possible, is_possible, context) == JoinObstacle::none) return join;
  }
  return std::nullopt;
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

bool are_places_compared_at(std::ptrdiff_t keyframes) {
  constexpr std::ptrdiff_t always_up_to = 12;
  constexpr double per_doubling = 10;
  const auto steps_at = [](std::ptrdiff_t count) {
    return std::floor(per_doubling * std::log2(static_cast<double>(count)));
  };
  return keyframes <= always_up_to || steps_at(keyframes) > steps_at(keyframes - 1);
}

std::optional<MapJoin> find_certain_join(int map, std::span<const PoseEdge> possible,
                                         const IsPossibleJoin& is_possible,
                                         const JoinContext& context) {
  return certain_join(map, possible, is_possible, context, least_agreeing_keyframes);
}

JoinChoice choose_join(int map, std::span<const PoseEdge> sure, std::span<const PoseEdge> possible,
                       const IsPossibleJoin& is_possible, const JoinContext& context) {
  JoinChoice choice;
  choice.agreeing =
      static_cast<int>(most_that_agree(pointers_to(sure), context.keyframes, context.loops).size());
  choice.join = find_join(sure, map, context.keyframes, context.loops);
  if (!choice.join) return choice;
  choice.obstacle = obstacle_of(*choice.join, possible, is_possible, context);
  const bool is_sure = choice.obstacle == JoinObstacle::none;
  if (recognising_keyframes(pointers_to(choice.join->edges)) < least_agreeing_so_far) {
    choice.join.reset();
    if (is_sure) choice.obstacle = JoinObstacle::too_few;
  } else if (!is_sure) {
    choice.join.reset();
    if (are_places_compared_at(std::ranges::count(context.keyframes, map, &Keyframe::map))) {
      choice.join = certain_join(map, possible, is_possible, context, least_agreeing_so_far);
    }
    if (choice.join) choice.obstacle = JoinObstacle::none;
  }
  return choice;
}

JoinReview review_join(const MapJoin& join, std::span<const PoseEdge> possible,
                       const IsPossibleJoin& is_possible, const JoinContext& context,
                       std::size_t least_agreeing) {
  const JoinSearch search(join.map, context);
  const std::vector<double> violations = search.violations_at(join);
  const double half = mean_of_half(violations);
  std::vector<MapJoin> runners_up;
  bool is_another_better = false;
  for (const MapJoin& other : search.places(possible, &join)) {
    if (!is_possible(other)) continue;
    const double half_there = mean_of_half(search.violations_at(other));
    if (!is_clearly_less(half, half_there)) runners_up.push_back(other);
    if (is_clearly_less(half_there, half)) is_another_better = true;
  }
  const bool is_contradicted = mean_of(violations) >= most_violations_of_join;
  if (!is_contradicted && runners_up.empty()) return {};
  const JoinObstacle obstacle =
      is_contradicted ? JoinObstacle::contradicted : JoinObstacle::ambiguous;
  if (is_another_better) {
    const auto certain = certain_join(join.map, possible, is_possible, context, least_agreeing);
    if (certain && search.are_same(*certain, join)) return {};
    if (certain) return {obstacle, certain};
  }
  if (is_contradicted) return {obstacle, std::nullopt};
  const std::size_t fitting = search.fitting(join);
  const bool is_ambiguous = std::ranges::any_of(runners_up, [&](const MapJoin& runner_up) {
    return 2 * search.fitting(runner_up) >= fitting;
  });
  return {is_ambiguous ? obstacle : JoinObstacle::none, std::nullopt};
}

}  // namespace tofmap
