// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper closes loops, mends slips of odometry and fits the pose graph.

#include "tofmap/mapping/loop_closure.hpp"
#include "tofmap/mapping/loop_fit.hpp"
#include "tofmap/mapping/room_mapper.hpp"
#include "tofmap/mapping/slip_search.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace tofmap {

/// Searches for a loop of the newest keyframe and recognises its place in other maps, once per
/// keyframe. Fits the pose graph if there are new loops and the last fit was long enough ago.
void RoomMapper::close_loops() {
  if (searched_ == keyframes_.size()) return;
  searched_ = keyframes_.size();
  if (is_joined() && differs_from_others(keyframes_[keyframes_.size() - 1]) &&
      ++differing_keyframes_ >= least_differing_keyframes) {
    take_join_back();
  }
  recognise_place();
  if (!loop_options_.close) return;
  const Keyframe& keyframe = keyframes_[keyframes_.size() - 1];
  const LoopCandidate candidate =
      find_loop(keyframe, keyframes_.all(), keyframes_.spreads_from(keyframe.id), camera_,
                loop_options_, registration_);
  if (candidate.edge && candidate.needs_slip) {
    if (const auto slip = slip_behind(*candidate.edge)) {
      add_loop(*candidate.edge);
      mend(*slip);
    }
  } else if (candidate.edge) {
    add_loop(*candidate.edge);
  }
  if (unfitted_loops_ > 0 &&
      (loop_awaits_others() || keyframe.id - last_fit_ >= keyframes_between_fits)) {
    fit();
  }
}

/// The slip that explains a loop which drift does not explain. The search takes long, so there is
/// none for some keyframes after one that found no slip.
std::optional<Slip> RoomMapper::slip_behind(const PoseEdge& loop) {
  if (loop.to - last_slip_search_ < keyframes_between_fits) return std::nullopt;
  auto slip = find_slip(loop, keyframes_.all(), edges_, camera_, loop_options_, registration_);
  if (!slip) last_slip_search_ = loop.to;
  return slip;
}

/// Adds a loop to those that the next fit decides on. One that would move the path waits for
/// others.
void RoomMapper::add_loop(const PoseEdge& edge) {
  const Pose found = keyframes_[edge.from].world_from_camera * edge.from_from_to;
  const Pose& believed = keyframes_[edge.to].world_from_camera;
  const double error_m = (found.translation() - believed.translation()).norm();
  if (would_move(edge, keyframes_.all())) waiting_loop_ = edge.to;
  edges_.push_back(edge);
  loops_.push_back({.from_frame = keyframes_[edge.from].frame_index,
                    .to_frame = keyframes_[edge.to].frame_index,
                    .error_m = error_m});
  ++unfitted_loops_;
}

bool RoomMapper::loop_awaits_others() const {
  return waiting_loop_ >= 0 && waiting_loop_ + keyframes_between_fits >= keyframes_.size();
}

void RoomMapper::finish() {
  if (unfitted_loops_ > 0) fit();
}

/// Moves all keyframes, and what is known of the last frame with them.
void RoomMapper::set_poses(std::span<const Pose> poses) {
  const Pose current_before = keyframes_[current_].world_from_camera;
  for (int id = 0; id < keyframes_.size(); ++id) {
    keyframes_.set_pose(id, poses[static_cast<std::size_t>(id)]);
  }
  const Pose new_from_old_world = keyframes_[current_].world_from_camera * current_before.inverse();
  odometry_.move(new_from_old_world);
}

/// Searches for slips that explain the loops since the last fit, and mends them.
void RoomMapper::mend_slips() {
  std::vector<PoseEdge> loops;
  std::ranges::copy_if(edges_, std::back_inserter(loops), &PoseEdge::may_be_wrong);
  for (auto loop = loops.end() - unfitted_loops_; loop != loops.end(); ++loop) {
    const auto slip =
        find_slip(*loop, keyframes_.all(), edges_, camera_, loop_options_, registration_);
    if (slip) mend(*slip);
  }
}

/// Replaces the edges across a slip, and moves what is behind it.
void RoomMapper::mend(const Slip& slip) {
  edges_ = without_slip(edges_, slip);
  set_poses(fit_loops(keyframes_.all(), edges_, loop_options_).poses);
  rebuild_submaps(slip.at);
}

/// Separates the submaps that have keyframes on both sides of a slip, which have moved relative to
/// each other. Their surface is rebuilt from the keyframes: that of other frames cannot be told
/// apart any more.
void RoomMapper::rebuild_submaps(int at) {
  std::map<int, int> later_half;  // by the index of the submap
  for (int id = at; id < keyframes_.size(); ++id) {
    int& submap = submap_of_[static_cast<std::size_t>(id)];
    if (submaps_[static_cast<std::size_t>(submap)].anchor >= at) continue;
    const auto [half, is_new] = later_half.try_emplace(submap, static_cast<int>(submaps_.size()));
    if (is_new) submaps_.push_back({id, SurfaceMap(surface_options_)});
    submap = half->second;
  }
  for (const auto& [earlier, later] : later_half) {
    submaps_[static_cast<std::size_t>(earlier)].surface = SurfaceMap(surface_options_);
    for (const Keyframe& keyframe : keyframes_.all()) {
      const int submap = submap_of_[static_cast<std::size_t>(keyframe.id)];
      if (submap != earlier && submap != later) continue;
      const Pose anchor_from_world =
          keyframes_[submaps_[static_cast<std::size_t>(submap)].anchor].world_from_camera.inverse();
      submaps_[static_cast<std::size_t>(submap)].surface.integrate(
          *keyframe.cloud, anchor_from_world * keyframe.world_from_camera);
    }
  }
}

void RoomMapper::fit() {
  mend_slips();
  const LoopFit fitted = fit_loops(keyframes_.all(), edges_, loop_options_);
  set_poses(fitted.poses);
  waiting_loop_ = -1;
  keyframes_.forget_loops();
  auto loop = loops_.begin();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (!edges_[i].may_be_wrong) continue;
    loop->mahalanobis_distance = fitted.edge_mahalanobis[i];
    loop->is_used = fitted.is_used[i];
    if (loop->is_used) {
      // The relative pose of both ends is now correct, so frames may be registered with either.
      keyframes_.connect_by_loop(edges_[i].from, edges_[i].to, spread_of(edges_[i].covariance));
    } else {
      waiting_loop_ = std::max(waiting_loop_, edges_[i].to);
    }
    ++loop;
  }
  keyframes_.reconnect();
  unfitted_loops_ = 0;
  last_fit_ = keyframes_.size() - 1;
}

}  // namespace tofmap
