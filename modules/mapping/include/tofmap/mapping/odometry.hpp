// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/camera.hpp>
#include <tofmap/core/named_value.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/frame_constraint.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/mapping/motion_uncertainty.hpp>
#include <tofmap/mapping/pose_spread.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// Options of Odometry, and of where RoomMapper takes keyframes.
struct OdometryOptions {
  /// A frame becomes a keyframe if each nearby keyframe of its map is at least this far away, or
  /// `keyframe_rotation_rad` in rotation. Keyframes of an earlier visit must be twice as far away.
  /// A frame also becomes a keyframe if its position relative to them is uncertain by a fifth of
  /// this (one standard deviation), or if less than 70 % of its points have a correspondence in
  /// them. 0.01 … 10 m.
  double keyframe_translation_m = 0.25;
  /// Rotation from each nearby keyframe that makes a frame a keyframe, 0.01 … 3.2 rad. See
  /// `keyframe_translation_m`.
  double keyframe_rotation_rad = 0.21;
  /// Number of keyframes around the camera that are considered as targets, 1 … 1000.
  int keyframes_around = 15;
  /// Largest number of keyframes that a frame is registered with, 1 … 16: those that overlap it
  /// most, and one that constrains a direction which these do not.
  int targets = 3;
  /// Smallest share of a frame's points that a target must see, 0 … 1. The keyframe that the
  /// previous frame belongs to may see less.
  double min_target_overlap = 0.15;
  /// Standard deviation, per axis, of the change in frame-to-frame rotation from one frame to the
  /// next, 0.0001 … 3.2 rad. It is less while the motion is steady; see MotionUncertainty.
  double prior_rotation_sigma_rad = 0.03;
  /// Standard deviation, per axis, of the change in frame-to-frame translation from one frame to
  /// the next, 0.0001 … 10 m. It is less while the motion is steady.
  double prior_translation_sigma_m = 0.03;
  /// Largest difference between the registered and the predicted pose, in standard deviations of
  /// the prior, 1 … 1000. A pose that differs more is rejected.
  double max_prior_sigmas = 8;
  /// Whether unlikely poses are checked: other rotations are tried, and a pose that fits the
  /// surfaces far worse than is usual, or contradicts their free space, is rejected.
  bool check_poses = true;
  /// Whether people and other things that move are found (MovingRegions) and left out.
  bool leave_out_moving = true;

  static std::vector<OptionField<OdometryOptions>> fields();
};

/// What became of a frame.
enum class TrackingStatus {
  first,        ///< the first frame of a map: its camera is the origin of the map's world
  tracked,      ///< registered with the keyframes around
  no_surface,   ///< the frame has too few points with normals
  lost,         ///< registration failed or was rejected
  implausible,  ///< registration ended farther from the predicted pose than motion allows
  relocalised,  ///< tracked, and its map was joined with an earlier one (RoomMapper)
  repeated,     ///< the frame repeats the one before it, and was not registered
};

std::span<const NamedValue<TrackingStatus>> named_values(TrackingStatus);

/// Whether the pose of a frame of this status was found.
constexpr bool is_registered(TrackingStatus status) {
  return status == TrackingStatus::first || status == TrackingStatus::tracked ||
         status == TrackingStatus::relocalised;
}

/// What the motion since the latest keyframe, and the surfaces of that keyframe, tell of a pose.
struct SinceKeyframe {
  int keyframe = 0;  ///< id of the latest keyframe
  /// Of the error of the pose relative to this keyframe: rotation vector in radians, then
  /// translation in metres, along the axes of the world.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
};

/// How a frame was tracked.
struct TrackingResult {
  TrackingStatus status = TrackingStatus::lost;
  Pose world_from_camera = Pose::Identity();  ///< meaningful only if registered()
  bool is_keyframe = false;                   ///< whether RoomMapper made the frame a keyframe
  std::vector<int> targets;  ///< ids of the keyframes it was registered with, best overlap first
  RegistrationResult registration;  ///< all defaults if registration was not tried
  /// Covariance of the error of the pose relative to each target if the status is `tracked`, else
  /// empty: rotation vector in radians, then translation in metres, along the axes of the world.
  /// Each comes from the surfaces of that target alone (of the latest keyframe: as
  /// `since_keyframe`) and is large in directions that these do not constrain, even if other
  /// targets do. RoomMapper::add_frame() makes edges of the covariances and removes them.
  std::vector<Eigen::Matrix<double, 6, 6>> target_covariances;
  /// If the status is `tracked` and there is a keyframe. RoomMapper::add_frame() removes it as
  /// well.
  std::optional<SinceKeyframe> since_keyframe;
  /// What the surfaces tell of the pose relative to each keyframe, if the status is `tracked`.
  /// RoomMapper::add_frame() moves them to the frame of the map.
  std::vector<FrameConstraint> constraints;
  /// Whether frame and keyframes see through each other where they should not. It is tested only if
  /// the pose is unlikely.
  bool contradicts_targets = false;
  /// Covariance of the error of the pose relative to all targets together, as in
  /// `target_covariances`, if the status is `tracked`, else zero.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  PoseSpread spread;  ///< of `covariance`

  /// Whether the pose of the frame was found.
  bool registered() const { return is_registered(status); }
};

/// Tracks the camera: registers each frame with those keyframes around it that overlap it most,
/// from the pose that constant velocity predicts. The last of them is replaced by a keyframe that
/// constrains a direction which the others do not. The prior is as narrow as recent motion was
/// steady. If the result differs from it by more than three standard deviations, the motion has
/// changed, and the frame is registered again with the prior that the options give. After a gap in
/// time, the last known pose is tried as well, and registration may take three times as many
/// iterations. The first frame with a surface gets the identity as its pose. A frame that cannot be
/// registered only increases the time since the last registered frame.
///
/// The camera may move faster than the prior allows. With `check_poses`, if registration fails,
/// ends far from the predicted pose, or fits the surfaces clearly worse than the frames before, the
/// frame is also registered from the rotations around the last pose that search_rotations() finds.
/// The best of these results replaces the first one if it is verified as for a loop, except that
/// one direction of motion may be degenerate, no result at another place fits about as well, and
/// the first one failed or fits clearly worse. If none does, and the first one fits the surfaces
/// far worse than is usual or contradicts the free space of the keyframes, the frame is lost.
class Odometry {
 public:
  /// `recognition` has the limits for trusting a registration that does not follow from the motion
  /// of the camera.
  Odometry(const CameraModel& camera, const OdometryOptions& options,
           const RegistrationOptions& registration, const LoopOptions& recognition);

  /// Finds the pose of a frame. Frames must come in the order of time. `around` are keyframes whose
  /// relative poses are correct. The last of them is considered as a target even if it overlaps the
  /// frame by less than `min_target_overlap`. Without keyframes, every frame after the first
  /// registered one is lost. With `may_contradict`, a frame is not lost because it contradicts free
  /// space: something that moves may do so.
  TrackingResult track(double timestamp_s, const SurfaceCloud& cloud,
                       std::span<const Keyframe* const> around, bool may_contradict = false);

  /// Whether nearly as many correspondences of a registration fit its pose as is usual.
  bool fits_as_usual(const RegistrationResult& result) const;

  /// Must be called for every frame after registration was tried, whether here or elsewhere. The
  /// frame period of the camera is estimated from the timestamps.
  void note_frame(double timestamp_s);

  /// Where the camera is expected at a time. The identity if no frame was registered yet.
  Pose expected_pose(double timestamp_s) const;

  /// Whether the last registered frame is more than 3.5 frame periods before `timestamp_s`. Dropped
  /// frames count as well. False if no frame was registered yet.
  bool is_after_gap(double timestamp_s) const;

  /// Must be called when the last registered frame has become a keyframe. From then on, the
  /// uncertainty of the motion is that since this frame.
  void note_keyframe(int id);

  /// Forgets where the camera was: the next frame with a surface is the first one again.
  void start_anew();

  /// Transforms the poses of the last frames when the pose graph has moved their keyframes.
  void move(const Pose& new_from_old_world);

 private:
  friend struct SavedState;  // mapper_state.cpp

  /// A registration of the frame with some keyframes, and where it started.
  struct Attempt {
    MotionPrior prior;
    std::vector<const Keyframe*> targets;  ///< best overlap first
    RegistrationResult registration;
  };

  double periods_since_registered(double timestamp_s) const;
  Attempt register_from(const MotionPrior& prior, const SurfaceCloud& cloud,
                        std::span<const Keyframe* const> around) const;
  std::optional<Attempt> register_as_steady(const MotionPrior& prior, double timestamp_s,
                                            const SurfaceCloud& cloud,
                                            std::span<const Keyframe* const> around) const;
  Attempt register_as_predicted(double timestamp_s, const SurfaceCloud& cloud,
                                std::span<const Keyframe* const> around) const;
  std::optional<Attempt> register_turned(double periods, const SurfaceCloud& cloud,
                                         std::span<const Keyframe* const> around) const;
  bool is_turn(const RegistrationResult& result) const;
  bool is_suspect(const Attempt& attempt) const;
  bool is_credible(const RegistrationResult& result) const;
  bool contradicts_targets(const Attempt& attempt, const SurfaceCloud& cloud) const;
  TrackingStatus judge(const Attempt& attempt, double timestamp_s) const;
  MotionPrior predict(double timestamp_s) const;
  void note_change(double timestamp_s, const RegistrationResult& found);
  void learn_covariances(double periods, const Attempt& attempt, TrackingResult& result);
  void accept(const StampedPose& pose);

  CameraModel camera_;
  OdometryOptions options_;
  RegistrationOptions registration_;
  LoopOptions recognition_;
  std::optional<StampedPose> last_;
  std::optional<StampedPose> before_last_;
  int frames_since_registered_ = 0;
  std::vector<double> recent_periods_s_;  ///< times between successive frames, the newest last
  double last_timestamp_s_ = 0;           ///< of the last frame passed to note_frame()
  MotionUncertainty uncertainty_;         ///< of the last registered pose
  /// Id of the keyframe that `uncertainty_` refers to: the latest one, or, once that is no target
  /// any more, another one; −1 before the first one.
  int reference_ = -1;
  MotionUncertainty since_keyframe_;  ///< of the last registered pose relative to `latest_`
  int latest_ = -1;                   ///< id of the latest keyframe; −1 before the first one
  static constexpr double expected_support = 0.8;  ///< before any frame was registered
  static constexpr double expected_inlier_ratio = 0.9;
  /// Share of a frame's points that fit the surfaces, averaged over recent registered frames.
  double usual_support_ = expected_support;
  double usual_inlier_ratio_ = expected_inlier_ratio;  ///< averaged likewise
};

}  // namespace tofmap
