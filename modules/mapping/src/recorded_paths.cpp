// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "recorded_paths.hpp"

#include <span>

namespace tofmap {
namespace {

/// A camera that has gone for this many frame periods without a registered frame may have changed
/// its motion.
constexpr double longest_gap_periods = 3.5;

/// Whether the camera can have kept its motion from the end of a path to a frame.
bool goes_on(std::span<const std::size_t> path, const RegisteredFrame& frame,
             std::span<const RegisteredFrame> frames) {
  const RegisteredFrame& last = frames[path.back()];
  const double step_s = frame.timestamp_s - last.timestamp_s;
  if (step_s <= 0) return false;
  if (path.size() < 2) return true;
  const RegisteredFrame& before_last = frames[path[path.size() - 2]];
  return step_s <= longest_gap_periods * (last.timestamp_s - before_last.timestamp_s);
}

}  // namespace

std::vector<std::vector<std::size_t>> recorded_paths(const MapContent& content, int recording) {
  std::vector<std::vector<std::size_t>> paths;
  int map = -1;
  for (std::size_t i = 0; i < content.frames.size(); ++i) {
    const RegisteredFrame& frame = content.frames[i];
    if (frame.recording != recording) continue;
    const Keyframe& keyframe = content.keyframes[frame.keyframe];
    if (keyframe.map != map || !goes_on(paths.back(), frame, content.frames)) paths.emplace_back();
    map = keyframe.map;
    paths.back().push_back(i);
  }
  return paths;
}

bool is_of_keyframe(const RegisteredFrame& frame, const KeyframeGraph& keyframes) {
  const Keyframe& keyframe = keyframes[frame.keyframe];
  return keyframe.recording == frame.recording && keyframe.frame_index == frame.index;
}

}  // namespace tofmap
