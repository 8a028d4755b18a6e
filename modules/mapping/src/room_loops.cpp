// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper closes loops, mends slips of odometry and fits the pose graph.

#include "tofmap/mapping/change_detection.hpp"
#include "tofmap/mapping/loop_closure.hpp"
#include "tofmap/mapping/loop_fit.hpp"
#include "tofmap/mapping/map_fit.hpp"
#include "tofmap/mapping/path_fit.hpp"
#include "tofmap/mapping/path_smoothing.hpp"
#include "tofmap/mapping/room_mapper.hpp"
#include "tofmap/mapping/slip_search.hpp"
#include "tofmap/mapping/uncertain_start.hpp"

#include <algorithm>
#include <iterator>
#include <map>

namespace tofmap {

/// Searches for a loop of the newest keyframe and recognises its place in other maps, once per
/// keyframe. Fits the pose graph if there are new loops and the last fit was long enough ago.
void RoomMapper::close_loops() {
  if (searched_ == content_.keyframes.size()) return;
  searched_ = content_.keyframes.size();
  check_join();
  recognise_place();
  if (!loop_options_.close) return;
  const Keyframe& keyframe = content_.keyframes[content_.keyframes.size() - 1];
  const LoopCandidate candidate =
      find_loop(keyframe, content_.keyframes.all(), content_.keyframes.spreads_from(keyframe.id),
                camera_, loop_options_, registration_);
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
  auto slip = find_slip(loop, content_.keyframes.all(), content_.edges, camera_, loop_options_,
                        registration_);
  if (!slip) last_slip_search_ = loop.to;
  return slip;
}

/// Adds a loop to those that the next fit decides on. One that would move the path waits for
/// others.
void RoomMapper::add_loop(const PoseEdge& edge) {
  if (would_move(edge, content_.keyframes.all())) waiting_loop_ = edge.to;
  tofmap::add_loop(content_, edge);
  ++unfitted_loops_;
}

bool RoomMapper::loop_awaits_others() const {
  return waiting_loop_ >= 0 && waiting_loop_ + keyframes_between_fits >= content_.keyframes.size();
}

void RoomMapper::finish() {
  if (unfitted_loops_ > 0) fit();
  mend_uncertain_starts();
  review_join_of_newest(true);
  join_afterwards();
  if (unfitted_loops_ > 0) fit();
  const MotionUncertainty motion(odometry_options_.prior_rotation_sigma_rad,
                                 odometry_options_.prior_translation_sigma_m);
  fit_path(content_, recording(), loop_options_, motion, held_keyframes());
  smooth_path(content_, recording(), motion);
  // From here on, clouds are gone through in order.
  content_.keyframes.keep_clouds_compact();
  if (use_ == MapUse::localise) {
    // The map stays as it is, and with it what earlier recordings show.
    std::ranges::move(changes_since(content_, recording()), std::back_inserter(content_.changes));
  } else {
    content_.changes = find_changes(content_);
  }
}

/// Searches for slips that explain the loops since the last fit, and mends them.
void RoomMapper::mend_slips() {
  std::vector<PoseEdge> loops;
  std::ranges::copy_if(content_.edges, std::back_inserter(loops), &PoseEdge::may_be_wrong);
  for (auto loop = loops.end() - unfitted_loops_; loop != loops.end(); ++loop) {
    const auto slip = find_slip(*loop, content_.keyframes.all(), content_.edges, camera_,
                                loop_options_, registration_);
    if (slip) mend(*slip);
  }
}

/// Replaces the edges and constraints across a slip, and moves what is behind it.
void RoomMapper::mend(const Slip& slip) {
  content_.edges = without_slip(content_.edges, slip);
  for (RegisteredFrame& frame : content_.frames) {
    std::erase_if(frame.constraints, [&](const FrameConstraint& constraint) {
      return (constraint.keyframe < slip.at) != (frame.keyframe < slip.at);
    });
  }
  const Pose before = content_.keyframes[current_].world_from_camera;
  fit_poses(content_, loop_options_, held_keyframes());
  follow_keyframe(before);
  separate_submaps(slip.at);
}

/// Separates the submaps that have keyframes on both sides of a slip, which have moved relative to
/// each other.
void RoomMapper::separate_submaps(int at) {
  std::map<int, int> later_half;  // by the index of the submap
  for (int id = at; id < content_.keyframes.size(); ++id) {
    int& submap = content_.submap_of[static_cast<std::size_t>(id)];
    if (content_.submaps[static_cast<std::size_t>(submap)].anchor >= at) continue;
    const auto [half, is_new] =
        later_half.try_emplace(submap, static_cast<int>(content_.submaps.size()));
    if (is_new) content_.submaps.push_back({id, SurfaceMap(content_.surface_options)});
    submap = half->second;
  }
  std::set<int> changed;
  for (const auto& [earlier, later] : later_half) changed.insert({earlier, later});
  rebuild_submaps(changed);
}

/// Rebuilds the surface of submaps from their keyframes: that of other frames cannot be told apart
/// any more.
void RoomMapper::rebuild_submaps(const std::set<int>& submaps) {
  for (const int index : submaps) {
    Submap& submap = content_.submaps[static_cast<std::size_t>(index)];
    submap.surface = SurfaceMap(content_.surface_options);
    const Pose anchor_from_world = content_.keyframes[submap.anchor].world_from_camera.inverse();
    for (const Keyframe& keyframe : content_.keyframes.all()) {
      if (content_.submap_of[static_cast<std::size_t>(keyframe.id)] != index) continue;
      submap.surface.change().integrate(*keyframe.cloud.load(),
                                        anchor_from_world * keyframe.world_from_camera);
    }
  }
}

/// Mends the starts of the maps of this recording, and searches loops for their keyframes again.
void RoomMapper::mend_uncertain_starts() {
  std::set<int> maps;
  for (const Keyframe& keyframe : content_.keyframes.all()) {
    if (keyframe.recording == recording()) maps.insert(keyframe.taken_in);
  }
  for (const int map : maps) {
    const std::vector<int> mended =
        mend_uncertain_start(content_, map, odometry_options_, registration_, loop_options_);
    if (mended.empty()) continue;
    std::set<int> submaps;
    for (const int id : mended) submaps.insert(content_.submap_of[static_cast<std::size_t>(id)]);
    rebuild_submaps(submaps);
    return_to_origin(content_.keyframes[mended.front()].map);
    if (loop_options_.close) close_loops_of(mended);
  }
}

/// Searches loops for keyframes whose poses were not known well when they were taken.
void RoomMapper::close_loops_of(std::span<const int> keyframes) {
  for (const int id : keyframes) {
    const LoopCandidate loop =
        find_loop(content_.keyframes[id], content_.keyframes.all(),
                  content_.keyframes.spreads_from(id), camera_, loop_options_, registration_);
    if (loop.edge && !loop.needs_slip) add_loop(*loop.edge);
  }
}

/// Moves what is known of the last frame with its keyframe, which has moved.
void RoomMapper::follow_keyframe(const Pose& before) {
  odometry_.move(content_.keyframes[current_].world_from_camera * before.inverse());
}

void RoomMapper::fit() {
  mend_slips();
  const Pose before = content_.keyframes[current_].world_from_camera;
  fit_map(content_, loop_options_, held_keyframes());
  follow_keyframe(before);
  waiting_loop_ = -1;
  auto loop = content_.loops.begin();
  for (const PoseEdge& edge : content_.edges) {
    if (!edge.may_be_wrong) continue;
    if (!loop->is_used) waiting_loop_ = std::max(waiting_loop_, edge.to);
    ++loop;
  }
  unfitted_loops_ = 0;
  last_fit_ = content_.keyframes.size() - 1;
}

}  // namespace tofmap
