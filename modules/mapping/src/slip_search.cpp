// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/slip_search.hpp"

#include "registration_choice.hpp"
#include "tofmap/mapping/free_space.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/keyframe_graph.hpp"
#include "tofmap/mapping/verification.hpp"

#include <algorithm>

namespace tofmap {
namespace {

/// How far registration may end from its initial pose: the drift between the slip and the loop.
constexpr double tolerance_m = 0.05;
constexpr double tolerance_rad = 0.03;

using Others = std::vector<const Keyframe*>;

struct SlipSearch {
  std::span<const Keyframe> keyframes;
  std::span<const PoseEdge> edges;
  const CameraModel& camera;
  const LoopOptions& options;
  const RegistrationOptions& registration;

  const Keyframe& at(int id) const { return keyframes[static_cast<std::size_t>(id)]; }
  Others registered_with(int id) const;
  bool are_later_ones_held(int id) const;
  RegistrationResult register_at(const Pose& pose, int id, const Others& others) const;
  std::optional<RegistrationResult> slip_at(int id, const Others& others,
                                            const Pose& corrected) const;
};

/// The keyframes before one that odometry registered it with.
Others SlipSearch::registered_with(int id) const {
  Others others;
  for (const PoseEdge& edge : edges) {
    if (edge.to == id && edge.from < id && !edge.may_be_wrong) others.push_back(&at(edge.from));
  }
  return others;
}

/// Whether every keyframe after one was registered with it or a later one.
bool SlipSearch::are_later_ones_held(int id) const {
  std::vector<char> is_held(keyframes.size(), 0);
  for (const PoseEdge& edge : edges) {
    if (edge.may_be_wrong) continue;
    if (edge.from >= id && edge.to > edge.from) is_held[static_cast<std::size_t>(edge.to)] = 1;
  }
  return std::ranges::all_of(
      keyframes.subspan(static_cast<std::size_t>(id) + 1), [&](const Keyframe& keyframe) {
        return keyframe.map != at(id).map || is_held[static_cast<std::size_t>(keyframe.id)] != 0;
      });
}

RegistrationResult SlipSearch::register_at(const Pose& pose, int id, const Others& others) const {
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* other : others) targets.push_back(target_of(*other));
  return register_to_targets(*at(id).cloud.load(), targets, camera,
                             {.world_from_camera = pose,
                              .rotation_sigma_rad = tolerance_rad,
                              .translation_sigma_m = tolerance_m},
                             registration);
}

/// The registration of a keyframe at its corrected pose. Empty if that is not verified, or if it
/// fits at its believed pose nearly as well.
std::optional<RegistrationResult> SlipSearch::slip_at(int id, const Others& others,
                                                      const Pose& corrected) const {
  const Keyframe& keyframe = at(id);
  const auto cloud = keyframe.cloud.load();
  const Pose& believed = keyframe.world_from_camera;
  if (!are_near(corrected, believed, farthest_slip_m, options.max_rotation_rad) ||
      contradicts_free_space({cloud.get(), corrected}, target_of(*others.front()), camera)) {
    return std::nullopt;
  }
  RegistrationResult result = register_at(corrected, id, others);
  if (!are_near(result.world_from_camera, corrected, tolerance_m, tolerance_rad) ||
      !confirms_place(*others.front(), *cloud, result, camera, options)) {
    return std::nullopt;
  }
  const RegistrationResult again = register_at(believed, id, others);
  const bool stays = are_near(again.world_from_camera, believed, tolerance_m, tolerance_rad);
  if (stays && !is_clearly_better(result, again)) return std::nullopt;
  return result;
}

}  // namespace

std::optional<Slip> find_slip(const PoseEdge& loop, std::span<const Keyframe> keyframes,
                              std::span<const PoseEdge> edges, const CameraModel& camera,
                              const LoopOptions& options, const RegistrationOptions& registration) {
  const SlipSearch search{keyframes, edges, camera, options, registration};
  const Keyframe& first = search.at(loop.from);
  const Keyframe& last = search.at(loop.to);
  const Pose found = first.world_from_camera * loop.from_from_to;
  const Pose correction = found * last.world_from_camera.inverse();
  const double moved_m = (found.translation() - last.world_from_camera.translation()).norm();
  if (first.taken_in != last.taken_in || moved_m < KeyframeGraph::well_connected_sigma_m) {
    return std::nullopt;
  }
  std::optional<Slip> best;
  double best_support = 0;
  for (int id = loop.from + 1; id <= loop.to; ++id) {
    const Others others = search.registered_with(id);
    if (others.empty()) continue;
    const auto result = search.slip_at(id, others, correction * search.at(id).world_from_camera);
    if (!result || support(*result) <= best_support || !search.are_later_ones_held(id)) continue;
    best_support = support(*result);
    best = Slip{.at = id, .edges = {}};
    for (std::size_t i = 0; i < others.size(); ++i) {
      best->edges.push_back(edge_of(*others[i], id, result->world_from_camera,
                                    covariance_of(result->target_information[i])));
    }
  }
  return best;
}

std::vector<PoseEdge> without_slip(std::span<const PoseEdge> edges, const Slip& slip) {
  std::vector<PoseEdge> mended;
  for (const PoseEdge& edge : edges) {
    const auto [earlier, later] = std::minmax(edge.from, edge.to);
    const bool crosses = earlier < slip.at && later >= slip.at;
    if (edge.may_be_wrong || !crosses) mended.push_back(edge);
  }
  mended.insert(mended.end(), slip.edges.begin(), slip.edges.end());
  return mended;
}

}  // namespace tofmap
