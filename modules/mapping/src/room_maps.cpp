// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

// How RoomMapper begins maps, and drops those that are too small.

#include "tofmap/mapping/room_mapper.hpp"

#include <algorithm>
#include <utility>

namespace tofmap {
namespace {

/// Smallest number of frames of a map. Fewer show something that passed in front of the camera.
constexpr std::ptrdiff_t least_frames_of_map = 3;

}  // namespace

/// Begins a map with the frames that could not be registered, in order. Returns what became of
/// them, and of the frames of a map before that was too small to keep.
std::vector<LateFrame> RoomMapper::start_map() {
  std::vector<LateFrame> late = drop_fragment();
  map_ = begun_maps_++;
  odometry_.start_anew();
  lost_frames_ = 0;
  for (NewFrame& frame : std::exchange(held_, {})) {
    TrackingResult tracking = track(frame);
    if (tracking.registered()) integrate(*frame.cloud);
    late.push_back({frame.index, std::move(tracking), frame.cloud});
  }
  return late;
}

/// Removes the newest map if it has too few frames to be of use. Nothing refers to it then but
/// what was added last.
std::vector<LateFrame> RoomMapper::drop_fragment() {
  const auto is_of_newest = [&](const RegisteredFrame& frame) {
    return content_.keyframes[frame.keyframe].map == map_;
  };
  const auto first = std::ranges::find_if(content_.frames, is_of_newest);
  if (map_ + 1 != begun_maps_ || content_.frames.end() - first >= least_frames_of_map) return {};
  std::vector<LateFrame> dropped;
  for (auto frame = first; frame != content_.frames.end(); ++frame) {
    dropped.push_back({frame->index, TrackingResult{}, nullptr});
  }
  content_.frames.erase(first, content_.frames.end());
  const auto is_kept = [&](const Keyframe& keyframe) { return keyframe.map != map_; };
  const auto kept = static_cast<int>(std::ranges::count_if(content_.keyframes.all(), is_kept));
  const auto refers_to_dropped = [&](const PoseEdge& edge) { return edge.to >= kept; };
  std::erase_if(content_.edges, refers_to_dropped);
  const auto kept_loops = std::ranges::count_if(content_.edges, &PoseEdge::may_be_wrong);
  const auto dropped_loops = static_cast<int>(std::ssize(content_.loops) - kept_loops);
  unfitted_loops_ = std::max(0, unfitted_loops_ - dropped_loops);  // the newest ones
  content_.loops.resize(static_cast<std::size_t>(kept_loops));
  std::erase_if(recognitions_, refers_to_dropped);
  std::erase_if(possible_places_, refers_to_dropped);
  const auto is_dropped = [&](const Submap& submap) { return submap.anchor >= kept; };
  std::vector<int> new_index;  // halves of submaps that a slip separated may be behind dropped ones
  int kept_submaps = 0;
  for (const Submap& submap : content_.submaps) {
    new_index.push_back(kept_submaps);
    kept_submaps += is_dropped(submap) ? 0 : 1;
  }
  std::erase_if(content_.submaps, is_dropped);
  content_.submap_of.resize(static_cast<std::size_t>(kept));
  for (int& submap : content_.submap_of) submap = new_index[static_cast<std::size_t>(submap)];
  content_.keyframes.shrink(kept);
  searched_ = std::min(searched_, kept);
  last_slip_search_ = std::min(last_slip_search_, kept - 1);
  return dropped;
}

}  // namespace tofmap
