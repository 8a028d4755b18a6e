// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

struct OdometryOptions {
  double keyframe_step_m = 0.25;
  double keyframe_turn_rad = 0.21;
  int recent_keyframes = 15;
  int targets = 3;
  double min_target_overlap = 0.15;
  double prior_rotation_sigma_rad = 0.03;
  double prior_translation_sigma_m = 0.03;
  double max_prior_deviation = 8;

  static std::vector<OptionField<OdometryOptions>> fields();
};

enum class TrackingStatus {
  first,  ///< the first usable frame: it defines the world
  tracked,
  no_surface,   ///< the frame has too few points with normals
  lost,         ///< registration failed
  implausible,  ///< registration ended farther from the expected pose than motion allows
  relocalised,  ///< lost before, and found again by a keyframe
};

const char* status_name(TrackingStatus status);

struct TrackingResult {
  TrackingStatus status = TrackingStatus::lost;
  Pose world_from_camera = Pose::Identity();  ///< meaningful only if `placed`
  bool is_keyframe = false;
  std::vector<int> targets;  ///< ids of the keyframes it was registered against
  RegistrationResult registration;

  bool placed() const {
    return status == TrackingStatus::first || status == TrackingStatus::tracked ||
           status == TrackingStatus::relocalised;
  }
};

/// Follows the camera: registers each frame against the best-overlapping of the recent
/// keyframes, starting from constant velocity. The world is the frame of the first usable
/// cloud. A frame that cannot be placed changes nothing but the time since the last placed one.
class Odometry {
 public:
  Odometry(const CameraModel& camera, const OdometryOptions& options,
           const RegistrationOptions& registration);

  /// Frames come in the order of time.
  TrackingResult track(int frame_index, double timestamp_s,
                       const std::shared_ptr<const SurfaceCloud>& cloud);

  /// The keyframes that are still held, oldest first.
  const std::deque<Keyframe>& recent_keyframes() const { return keyframes_; }

  /// Keyframes over the whole run.
  int keyframe_count() const { return keyframe_count_; }

  /// Goes on from a frame that was placed otherwise, among these keyframes instead of the recent
  /// ones; the last of them is the nearest. They must not be empty.
  void restart(const StampedPose& pose, std::span<const Keyframe> keyframes);

  /// Moves keyframes, by their ids, to where they are now believed to be, and the camera with the
  /// newest of them.
  void correct(std::span<const Pose> world_from_keyframe);

 private:
  MotionPrior predict(double timestamp_s) const;
  std::vector<const Keyframe*> choose_targets(const SurfaceCloud& cloud,
                                              const Pose& expected) const;
  bool wants_keyframe(const Pose& pose) const;
  void accept(int frame_index, double timestamp_s, const std::shared_ptr<const SurfaceCloud>& cloud,
              TrackingResult& result);

  CameraModel camera_;
  OdometryOptions options_;
  RegistrationOptions registration_;
  std::deque<Keyframe> keyframes_;
  int keyframe_count_ = 0;
  std::optional<StampedPose> last_;
  std::optional<StampedPose> before_last_;
  int frames_since_placed_ = 0;
};

}  // namespace tofmap
