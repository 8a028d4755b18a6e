// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/unwrapped_frame.hpp"

#include <deque>
#include <optional>
#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/filters/view_fusion.hpp>

namespace tofmap::app {

/// Frames in the order of time, each fused with those before and after it whose pose is known.
/// Without poses they pass as they are.
class FrameFusion {
 public:
  FrameFusion(const CameraModel& camera, const PixelRays& rays, Trajectory poses,
              const FusionOptions& options);

  void add(UnwrappedFrame frame);

  /// The frames since the last call whose neighbours are all there, fused, in their order; all that
  /// are left `at_the_end`.
  std::vector<UnwrappedFrame> take(bool at_the_end);

 private:
  struct Held {
    UnwrappedFrame frame;
    std::optional<Pose> world_from_camera;
  };

  UnwrappedFrame fused(std::size_t place);

  CameraModel camera_;
  const PixelRays& rays_;
  Trajectory poses_;
  FusionOptions options_;
  std::deque<Held> held_;  ///< up to `options_.views` that were taken, and all that were not
  std::size_t taken_ = 0;
};

}  // namespace tofmap::app
