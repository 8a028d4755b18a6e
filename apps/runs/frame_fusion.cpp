// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "runs/frame_fusion.hpp"

#include <algorithm>

#include <tofmap/pipeline/side_by_side.hpp>

namespace tofmap::app {

FrameFusion::FrameFusion(const CameraModel& camera, const PixelRays& rays, Trajectory poses,
                         const FusionOptions& options)
    : camera_(camera), rays_(rays), poses_(std::move(poses)), options_(options) {
  if (poses_.empty()) options_.views = 0;
}

void FrameFusion::add(UnwrappedFrame frame) {
  std::optional<Pose> pose;
  if (frame.damage.empty()) pose = pose_at(poses_, frame.timestamp_s);
  held_.push_back({std::move(frame), pose});
}

std::vector<UnwrappedFrame> FrameFusion::take(bool at_the_end) {
  const auto views = static_cast<std::size_t>(options_.views);
  const std::size_t after = at_the_end ? 0 : views;
  if (held_.size() <= taken_ + after) return {};
  const std::size_t first = taken_;
  const int count = static_cast<int>(held_.size() - after - first);
  std::vector<UnwrappedFrame> frames =
      side_by_side(count, [&](int i) { return fused(first + static_cast<std::size_t>(i)); });
  taken_ += frames.size();
  while (taken_ > views) {
    held_.pop_front();
    --taken_;
  }
  return frames;
}

UnwrappedFrame FrameFusion::fused(std::size_t place) {
  const auto views = static_cast<std::size_t>(options_.views);
  if (views == 0) return std::move(held_[place].frame);  // no other frame needs it
  const Held& own = held_[place];
  UnwrappedFrame out = own.frame;
  if (!own.world_from_camera) return out;
  std::vector<PosedView> others;
  const std::size_t end = std::min(held_.size(), place + views + 1);
  for (std::size_t i = place > views ? place - views : 0; i < end; ++i) {
    const Held& other = held_[i];
    if (i == place || !other.world_from_camera) continue;
    others.push_back({&other.frame.image, *other.world_from_camera});
  }
  out.image =
      fuse_views({&own.frame.image, *own.world_from_camera}, others, camera_, rays_, options_);
  out.report["fused_views"] = others.size();
  out.report["seen_through_pixels"] = count_reason(out.image, InvalidReason::seen_through);
  return out;
}

}  // namespace tofmap::app
