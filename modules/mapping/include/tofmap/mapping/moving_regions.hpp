// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/pose_spread.hpp>

namespace tofmap {

/// A keyframe that a frame is compared with.
struct ComparedKeyframe {
  const Keyframe* keyframe = nullptr;
  PoseSpread spread;  ///< of the frame's pose relative to the keyframe
};

/// A keyframe in which something moved.
struct CleanedKeyframe {
  int id = 0;
  KeyframeCloud cloud;  ///< without the points of what moved
};

/// A point of something that moves.
struct MovingPoint {
  Eigen::Vector3d world_m;
  int age = 0;  ///< number of frames since the last evidence that it moves
};

/// The confidence that marks a point of something that moves.
constexpr float moving_confidence = -1;

/// Whether a point was found to be on something that moves. It keeps its position, up to which
/// space is free, but has no normal.
inline bool moves(const SurfacePoint& point) { return point.confidence == moving_confidence; }

/// What moves in a frame, as regions of its image and of those of keyframes.
struct Motion {
  /// The frame's cloud without the surface of what moves (moves()). The same object as the input if
  /// nothing does.
  std::shared_ptr<const SurfaceCloud> still;
  std::vector<CleanedKeyframe> keyframes;  ///< those in which something has moved since
  std::vector<MovingPoint> points;         ///< one for each cell of the grid that moves
  /// Whether more contradicts the keyframes than agrees with them: the pose, or the place, is
  /// wrong. Nothing is said to move then.
  bool contradicts_pose = false;

  bool is_empty() const { return points.empty() && keyframes.empty(); }
};

/// Distinguishes people, doors and other things that move from the room, region by region.
///
/// Where a keyframe saw through to a surface behind, there is something now that was not there
/// before; where the frame sees through a surface of a keyframe, that surface is gone. Such points
/// are the evidence. From them, regions grow over the image, as far as the depth is continuous and
/// no keyframe agrees that the surface was there before. What moved in the frame before is expected
/// to keep moving, for 15 frames after the last evidence: somebody who walks ahead of the camera,
/// at its pace, covers what keyframes could see through.
///
/// Where surfaces hardly constrain the pose, a wall that comes into view is not where it is
/// expected. So differences count only beyond three standard deviations of the pose relative to the
/// keyframe.
///
/// Regions are found on a coarse grid of about 1/32 rad; those with fewer than six cells of
/// evidence are ignored. If more than half of what can be compared, apart from what moved in the
/// frame before, contradicts the keyframes, the pose is wrong rather than the room, and nothing is
/// said to move.
class MovingRegions {
 public:
  explicit MovingRegions(const CameraModel& camera) : camera_(camera) {}

  /// A frame's cloud at its expected pose, without the points of what moved in the frame before.
  /// The same object if nothing did.
  std::shared_ptr<const SurfaceCloud> without_known(
      const std::shared_ptr<const SurfaceCloud>& cloud, const Pose& world_from_camera) const;

  /// A frame's cloud without things in front of others: whatever begins below a surface that is at
  /// least 0.3 m farther away, as people and furniture do. Walls and columns reach up to the
  /// ceiling or the border of the image, if the camera is held upright. The same object if there
  /// are none.
  std::shared_ptr<const SurfaceCloud> background(
      const std::shared_ptr<const SurfaceCloud>& cloud) const;

  /// What moves in a frame whose pose is known, compared with keyframes. The result is the same for
  /// any number of threads.
  Motion find(const std::shared_ptr<const SurfaceCloud>& cloud, const Pose& world_from_camera,
              std::span<const ComparedKeyframe> keyframes) const;

  /// Expects what moves in a frame to be near the same places in the next one. If nothing is known
  /// of the frame, since its pose is contradicted, expects what moved in the frame before.
  void remember(const Motion& motion);

  /// Transforms the remembered places when the pose graph has moved the keyframes around.
  void move(const Pose& new_from_old_world);

 private:
  friend struct SavedState;  // mapper_state.cpp

  CameraModel camera_;
  std::vector<MovingPoint> known_;
};

}  // namespace tofmap
