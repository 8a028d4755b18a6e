// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <optional>

#include <tofmap/filters/view_fusion.hpp>

namespace tofmap {

/// A frame after fusion.
struct FusedFrame {
  RangeImage image;
  int views = 0;  ///< other frames that it was fused with
};

/// Fuses each frame of a recording with `FusionOptions::views` frames before and after it
/// (fuse_views). Frames without a pose are not fused, and take no part in the fusion of others.
///
///   fusion.add(image, pose);                                  // for each frame, in order of time
///   for (int i = 0; i < fusion.ready(is_last); ++i) use(fusion.fused(i));
///   fusion.drop(fusion.ready(is_last));
class SlidingFusion {
 public:
  /// `rays` must outlive this.
  SlidingFusion(const CameraModel& camera, const PixelRays& rays, const FusionOptions& options);

  void add(RangeImage image, const std::optional<Pose>& world_from_camera);

  /// How many frames can be fused now: those whose later neighbours have been added, or all
  /// `at_the_end` of the recording.
  int ready(bool at_the_end) const;

  /// The frame that was added `place` frames after the first one that was not dropped. May be
  /// called from several threads.
  FusedFrame fused(int place) const;

  /// Marks the first `count` frames as done. They are kept only as long as later frames need them.
  void drop(int count);

 private:
  struct Frame {
    RangeImage image;
    std::optional<Pose> world_from_camera;
  };

  CameraModel camera_;
  const PixelRays& rays_;
  FusionOptions options_;
  std::deque<Frame> frames_;  ///< at most options_.views that are done, and all that are not
  int done_ = 0;              ///< of frames_
};

}  // namespace tofmap
