// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/slip_search.hpp"

#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_graph.hpp"

#include <algorithm>

namespace tofmap {
namespace {

constexpr double farthest_m = 0.5;

/// How far registration may move a keyframe from its corrected pose: the drift between the slip and
/// the loop.
constexpr double tolerance_m = 0.05;
constexpr double tolerance_rad = 0.03;

struct SlipSearch {
  std::span<const Keyframe> keyframes;
  std::span<const PoseEdge> edges;
  const CameraModel& camera;
  const LoopOptions& options;
  const RegistrationOptions& registration;

  const Keyframe& at(int id) const { return keyframes[static_cast<std::size_t>(id)]; }
  std::vector<const Keyframe*> registered_with(int id) const;
  RegistrationResult registered(int id, const std::vector<const Keyframe*>& others,
                                const Pose& expected) const;
};

/// The keyframes before one that odometry registered it with.
std::vector<const Keyframe*> SlipSearch::registered_with(int id) const {
  std::vector<const Keyframe*> others;
  for (const PoseEdge& edge : edges) {
    if (edge.to == id && edge.from < id && !edge.may_be_wrong) others.push_back(&at(edge.from));
  }
  return others;
}

RegistrationResult SlipSearch::registered(int id, const std::vector<const Keyframe*>& others,
                                          const Pose& expected) const {
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* other : others) targets.push_back(target_of(*other));
  return register_to_targets(*at(id).cloud, targets, camera,
                             {.world_from_camera = expected,
                              .rotation_sigma_rad = tolerance_rad,
                              .translation_sigma_m = tolerance_m},
                             registration);
}

bool is_near(const Pose& one, const Pose& other, double distance_m, double angle_rad) {
  return (one.translation() - other.translation()).norm() < distance_m &&
         rotation_angle_rad(one, other) < angle_rad;
}

}  // namespace

std::optional<Slip> find_slip(const PoseEdge& loop, std::span<const Keyframe> keyframes,
                              std::span<const PoseEdge> edges, const CameraModel& camera,
                              const LoopOptions& options, const RegistrationOptions& registration) {
  const SlipSearch search{keyframes, edges, camera, options, registration};
  const Pose& believed = search.at(loop.to).world_from_camera;
  const Pose found = search.at(loop.from).world_from_camera * loop.from_from_to;
  if ((found.translation() - believed.translation()).norm() < KeyframeGraph::tied_sigma_m)
    return {};
  const Pose correction = found * believed.inverse();
  std::optional<Slip> best;
  double best_support = 0;
  for (int id = loop.from + 1; id <= loop.to; ++id) {
    const Keyframe& keyframe = search.at(id);
    const Pose corrected = correction * keyframe.world_from_camera;
    const auto others = search.registered_with(id);
    if (others.empty() ||
        !is_near(corrected, keyframe.world_from_camera, farthest_m, options.max_rotation_rad) ||
        contradicts_free_space({keyframe.cloud.get(), corrected}, target_of(*others.front()),
                               camera)) {
      continue;
    }
    const RegistrationResult result = search.registered(id, others, corrected);
    if (support(result) <= best_support ||
        !is_near(result.world_from_camera, corrected, tolerance_m, tolerance_rad) ||
        !confirms_place(*others.front(), *keyframe.cloud, result, camera, options) ||
        support(result) < support(search.registered(id, others, keyframe.world_from_camera))) {
      continue;
    }
    best_support = support(result);
    best = Slip{.at = id, .edges = {}};
    for (std::size_t i = 0; i < others.size(); ++i) {
      best->edges.push_back(edge_of(*others[i], id, result.world_from_camera,
                                    covariance_of(result.target_information[i])));
    }
  }
  return best;
}

std::vector<PoseEdge> without_slip(std::span<const PoseEdge> edges, const Slip& slip) {
  std::vector<PoseEdge> mended;
  for (const PoseEdge& edge : edges) {
    const bool crosses =
        std::min(edge.from, edge.to) < slip.at && std::max(edge.from, edge.to) >= slip.at;
    if (edge.may_be_wrong || !crosses) mended.push_back(edge);
  }
  mended.insert(mended.end(), slip.edges.begin(), slip.edges.end());
  return mended;
}

}  // namespace tofmap
