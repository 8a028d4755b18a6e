// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <tofmap/mapping/keyframe_graph.hpp>
#include <tofmap/mapping/moving_regions.hpp>
#include <tofmap/mapping/odometry.hpp>

namespace tofmap {

/// What became of a frame.
struct StillTracking {
  TrackingResult tracking;
  /// The frame's cloud as it may enter keyframes and the map: without what moves, and without what
  /// stands in front if the background determined the pose. The frame's own cloud if nothing is
  /// left out.
  std::shared_ptr<const SurfaceCloud> still;
  std::vector<CleanedKeyframe> before;  ///< the keyframes that have other clouds now, as they were
};

/// Gives keyframes other clouds. Returns those that they had.
std::vector<CleanedKeyframe> exchange_clouds(std::span<const CleanedKeyframe> others,
                                             KeyframeGraph& keyframes);

/// Tracks the camera (Odometry) by what does not move: people, doors and other things that move
/// (MovingRegions) have no part in registration.
///
/// A frame is registered without what moved in the frame before, and then again without what is
/// found to move at the resulting pose. The first pose may contradict the free space of keyframes,
/// since things do that have not moved before, the second one may not. In the first 15 frames of a
/// map, and whenever a frame fits worse than is usual, the background is also registered without
/// the things in front of it, and determines the pose if the two results differ.
///
/// With `leave_out_moving` off, and with PCL's methods of registration, this is Odometry alone.
class StillOdometry {
 public:
  /// The arguments of Odometry.
  StillOdometry(const CameraModel& camera, const OdometryOptions& options,
                const RegistrationOptions& registration, const LoopOptions& recognition);

  /// Finds the pose of a frame and what moves in it. What has moved since in `keyframes` is taken
  /// out of their clouds. `around` and `compared` point into `keyframes`: the frame is registered
  /// with the former (Odometry::track()); those of the latter that it was registered with, and the
  /// first one of them, tell what moves. The first one should be the oldest, which may have seen
  /// what is behind a thing that has moved since. If `compared` is empty, nothing is said to move.
  StillTracking track(double timestamp_s, const std::shared_ptr<const SurfaceCloud>& cloud,
                      std::span<const Keyframe* const> around,
                      std::span<const Keyframe* const> compared, KeyframeGraph& keyframes);

  /// See the functions of Odometry of these names.
  void note_frame(double timestamp_s) { odometry_.note_frame(timestamp_s); }
  bool is_after_gap(double timestamp_s) const { return odometry_.is_after_gap(timestamp_s); }
  void note_keyframe(int id) { odometry_.note_keyframe(id); }

  /// Forgets where the camera was and what moves: the next frame with a surface is the first one
  /// again.
  void start_anew();

  /// Transforms all that is known when the pose graph has moved the keyframes around.
  void move(const Pose& new_from_old_world);

 private:
  friend struct SavedState;  // mapper_state.cpp

  bool track_background(double timestamp_s, const std::shared_ptr<const SurfaceCloud>& cloud,
                        std::span<const Keyframe* const> around, const Odometry& before,
                        TrackingResult& all);

  CameraModel camera_;
  bool leaves_out_moving_;
  Odometry odometry_;
  MovingRegions moving_;              ///< at the last registered frame
  int frames_since_front_moved_ = 0;  ///< since the beginning of the map, or since that was found
};

}  // namespace tofmap
