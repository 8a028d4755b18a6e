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
  int views = 0;  ///< number of other frames that it was fused with
};

/// Fuses each frame of a recording with `FusionOptions::views` frames before and after it, by
/// fuse_views(). A frame without a pose is returned unchanged, and is not used for other frames.
///
///   fusion.add(image, pose);                                  // for each frame, in order of time
///   for (int i = 0; i < fusion.ready(is_last); ++i) use(fusion.fused(i));
///   fusion.drop(fusion.ready(is_last));
class SlidingFusion {
 public:
  /// `rays` are those of `camera`, and must outlive the object.
  SlidingFusion(const CameraModel& camera, const PixelRays& rays, const FusionOptions& options);

  /// Adds the next frame. `world_from_camera` is empty if the frame was not registered.
  void add(RangeImage image, const std::optional<Pose>& world_from_camera);

  /// The number of frames that can be fused now: those for which all later neighbours have been
  /// added, or all remaining frames if `at_the_end` of the recording.
  int ready(bool at_the_end) const;

  /// Fuses a frame. `place` counts from the first frame that was not dropped,
  /// 0 … ready() − 1. May be called from several threads at the same time. Throws UsageError if an
  /// image has another size than the rays.
  FusedFrame fused(int place) const;

  /// Marks the first `count` frames as done. They stay in memory only as long as later frames are
  /// to be fused with them.
  void drop(int count);

 private:
  struct Frame {
    RangeImage image;
    std::optional<Pose> world_from_camera;
  };

  CameraModel camera_;
  const PixelRays& rays_;
  FusionOptions options_;
  std::deque<Frame> frames_;  ///< at most options_.views done frames, and all that are not done
  int done_ = 0;              ///< number of done frames at the front of frames_
};

}  // namespace tofmap
