// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/filters/sliding_fusion.hpp"

#include <algorithm>

namespace tofmap {

SlidingFusion::SlidingFusion(const CameraModel& camera, const PixelRays& rays,
                             const FusionOptions& options)
    : camera_(camera), rays_(rays), options_(options) {}

void SlidingFusion::add(RangeImage image, const std::optional<Pose>& world_from_camera) {
  frames_.push_back({std::move(image), world_from_camera});
}

int SlidingFusion::ready(bool at_the_end) const {
  const int waiting = at_the_end ? 0 : options_.views;
  return std::max(0, static_cast<int>(frames_.size()) - done_ - waiting);
}

FusedFrame SlidingFusion::fused(int place) const {
  const int index = done_ + place;
  const Frame& own = frames_[static_cast<std::size_t>(index)];
  if (options_.views == 0 || !own.world_from_camera) return {own.image, 0};
  std::vector<PosedView> others;
  const int end = std::min(static_cast<int>(frames_.size()), index + options_.views + 1);
  for (int i = std::max(0, index - options_.views); i < end; ++i) {
    const Frame& other = frames_[static_cast<std::size_t>(i)];
    if (i == index || !other.world_from_camera) continue;
    others.push_back({&other.image, *other.world_from_camera});
  }
  return {fuse_views({&own.image, *own.world_from_camera}, others, camera_, rays_, options_),
          static_cast<int>(others.size())};
}

void SlidingFusion::drop(int count) {
  done_ += count;
  while (done_ > options_.views) {
    frames_.pop_front();
    --done_;
  }
}

}  // namespace tofmap
