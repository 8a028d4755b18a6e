// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/motion_uncertainty.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace boost::serialization {
class access;
}

namespace tofmap {

struct OdometryOptions {
  double keyframe_translation_m = 0.25;
  double keyframe_rotation_rad = 0.21;
  int keyframes_around = 15;
  int targets = 3;
  double min_target_overlap = 0.15;
  double prior_rotation_sigma_rad = 0.03;
  double prior_translation_sigma_m = 0.03;
  double max_prior_mahalanobis = 8;

  static std::vector<OptionField<OdometryOptions>> fields();
};

enum class TrackingStatus {
  first,  ///< the first usable frame: it defines the world
  tracked,
  no_surface,   ///< the frame has too few points with normals
  lost,         ///< registration failed, or is not believed
  implausible,  ///< registration ended farther from the expected pose than motion allows
  relocalised,  ///< lost before, and found again by a keyframe
  repeated,     ///< the frame repeats the one before it, and was not registered
};

const char* status_name(TrackingStatus status);

struct TrackingResult {
  TrackingStatus status = TrackingStatus::lost;
  Pose world_from_camera = Pose::Identity();  ///< meaningful only if `registered`
  bool is_keyframe = false;                   ///< it has become one (RoomMapper decides)
  std::vector<int> targets;  ///< ids of the keyframes it was registered against, best overlap first
  RegistrationResult registration;
  /// Covariance of the error of world_from_camera, if the status is `tracked`: rotation vector in
  /// radians, then translation in metres, along the axes of the world. It is that of a filter over
  /// the frames so far (MotionUncertainty), and not registration.covariance, which takes the motion
  /// prior of this frame for independent of the frames before it.
  Eigen::Matrix<double, 6, 6> pose_covariance = Eigen::Matrix<double, 6, 6>::Zero();

  bool registered() const {
    return status == TrackingStatus::first || status == TrackingStatus::tracked ||
           status == TrackingStatus::relocalised;
  }
};

/// Follows the camera: registers each frame against those keyframes around it that overlap most,
/// starting from constant velocity, and after a gap in time from where the camera was last as well,
/// with three times the iterations. The first frame with a surface is registered at the origin. A
/// frame that cannot be registered changes nothing but the time since the last registered one.
class Odometry {
 public:
  Odometry(const CameraModel& camera, const OdometryOptions& options,
           const RegistrationOptions& registration);

  /// Frames come in the order of time. `around` are keyframes that agree with one another; the last
  /// one is registered against in any case. They may be empty only for the first frame that is
  /// registered.
  /// Where `is_believed` says no of a registration, the camera counts as lost.
  TrackingResult track(double timestamp_s, const SurfaceCloud& cloud,
                       std::span<const Keyframe* const> around,
                       const std::function<bool(const RegistrationResult&)>& is_believed = {});

  /// To be called for every frame after it was tried, here or otherwise: the times between frames
  /// tell the camera's period.
  void note_frame(double timestamp_s);

  /// Whether the last frame that was registered is more than three periods of the camera ago:
  /// frames that never came count, too.
  bool is_after_gap(double timestamp_s) const;

  /// Whether a camera can have come there meanwhile.
  bool is_within_reach(double timestamp_s, const Pose& pose) const;

  /// Goes on from a frame that was registered otherwise.
  void restart(const StampedPose& pose);

  /// Moves the camera along with the keyframes that it is registered against.
  void move(const Pose& new_from_old_world);

 private:
  friend class boost::serialization::access;
  template <class Archive>
  void serialize(Archive& archive, unsigned version);  // mapper_archive.cpp

  double periods_since_registered(double timestamp_s) const;
  void register_from(const MotionPrior& prior, const SurfaceCloud& cloud,
                     std::span<const Keyframe* const> around, TrackingResult& result) const;
  MotionPrior predict(double timestamp_s) const;
  std::vector<const Keyframe*> choose_targets(const SurfaceCloud& cloud, const Pose& expected,
                                              std::span<const Keyframe* const> around) const;
  void accept(const StampedPose& pose);

  CameraModel camera_;
  OdometryOptions options_;
  RegistrationOptions registration_;
  std::optional<StampedPose> last_;
  std::optional<StampedPose> before_last_;
  int frames_since_registered_ = 0;
  std::vector<double> recent_periods_s_;  ///< from frame to frame, the newest last
  double last_timestamp_s_ = 0;           ///< of the last frame that was tried
  MotionUncertainty uncertainty_;         ///< of the last pose that was registered
};

}  // namespace tofmap
