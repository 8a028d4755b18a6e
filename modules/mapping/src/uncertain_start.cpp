// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/uncertain_start.hpp"

#include "registration_choice.hpp"
#include "target_choice.hpp"
#include "tofmap/mapping/keyframe_edge.hpp"
#include "tofmap/mapping/motion_uncertainty.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/LU>

namespace tofmap {
namespace {

using Covariance = MotionUncertainty::Covariance;
using Twist = MotionUncertainty::Twist;

/// Number of frames from which the motion after the start is learned.
constexpr std::size_t frames_of_motion = 100;

/// Number of keyframes that a keyframe of the start is registered with, at most.
constexpr std::size_t keyframes_after = 5;

/// A keyframe of the start where the motion and its surfaces put it.
struct Mended {
  int id = 0;
  Pose world_from_camera = Pose::Identity();
  Covariance covariance = Covariance::Zero();  ///< relative to the keyframe after it, world's axes
};

/// Predicts over frames without surfaces, in each of which the motion may change, to one whose
/// surfaces give information.
void learn_over(int frames, const Covariance& information, MotionUncertainty& motion) {
  for (int i = 1; i < frames; ++i) motion.learn(1, Covariance::Zero());
  motion.learn(1, information);
}

/// The camera on its way back to the start: time is reversed.
class WayBack {
 public:
  WayBack(const MapContent& content, int taken_in, const OdometryOptions& odometry,
          const RegistrationOptions& registration, const LoopOptions& recognition);

  /// The keyframes of the start, mended, the last one first. Empty if the start is certain, by
  /// odometry or by loops, if nothing after it is, or if one of them does not fit.
  std::vector<Mended> go();

  /// The first keyframe after the start. There is one if go() has found something.
  const Keyframe& end() const { return *keyframes_[length_]; }

 private:
  std::size_t length_of_start() const;
  bool is_certain(const Keyframe& keyframe) const;
  bool is_held_by_loops(std::size_t count) const;
  void learn_motion();
  Pose predict(double timestamp_s) const;
  std::optional<Mended> step_to(const Keyframe& keyframe);
  void pass(const StampedPose& pose, int frame);

  const MapContent& content_;
  const OdometryOptions& odometry_;
  const RegistrationOptions& registration_;
  const LoopOptions& recognition_;
  std::vector<const Keyframe*> keyframes_;  ///< of the map, in order
  std::size_t length_ = 0;                  ///< number of keyframes of the start
  std::vector<Keyframe> passed_;            ///< the nearest one last, mended
  std::optional<StampedPose> last_;
  std::optional<StampedPose> before_last_;
  int last_frame_ = 0;
  MotionUncertainty motion_;
};

WayBack::WayBack(const MapContent& content, int taken_in, const OdometryOptions& odometry,
                 const RegistrationOptions& registration, const LoopOptions& recognition)
    : content_(content),
      odometry_(odometry),
      registration_(registration),
      recognition_(recognition),
      motion_(odometry.prior_rotation_sigma_rad, odometry.prior_translation_sigma_m) {
  for (const Keyframe& keyframe : content.keyframes.all()) {
    if (keyframe.taken_in == taken_in) keyframes_.push_back(&keyframe);
  }
  length_ = length_of_start();
}

/// Whether odometry is certain of a keyframe relative to those of the map before it.
bool WayBack::is_certain(const Keyframe& keyframe) const {
  Covariance information = Covariance::Zero();
  for (const PoseEdge& edge : content_.edges) {
    if (edge.to != keyframe.id || edge.from > edge.to || edge.may_be_wrong) continue;
    if (content_.keyframes[edge.from].taken_in != keyframe.taken_in) continue;
    information += edge.covariance.inverse();
  }
  return !is_uncertain(spread_of(covariance_of(information)), odometry_);
}

/// Whether a loop that the last fit has used connects the first keyframes with others: then their
/// poses are known.
bool WayBack::is_held_by_loops(std::size_t count) const {
  const auto is_of_start = [&](int id) {
    const auto start = std::span(keyframes_).first(count);
    return std::ranges::find(start, id, &Keyframe::id) != start.end();
  };
  auto loop = content_.loops.begin();
  for (const PoseEdge& edge : content_.edges) {
    if (!edge.may_be_wrong) continue;
    const bool is_used = loop++->is_used;
    if (is_used && is_of_start(edge.from) != is_of_start(edge.to)) return true;
  }
  return false;
}

/// The number of keyframes before the first one that those after it are certain about.
std::size_t WayBack::length_of_start() const {
  std::size_t length = 0;
  while (length + 1 < keyframes_.size() && !is_certain(*keyframes_[length + 1])) ++length;
  return length + 1 < keyframes_.size() && !is_held_by_loops(length) ? length : 0;
}

std::vector<Mended> WayBack::go() {
  if (length_ == 0) return {};
  learn_motion();
  const std::size_t known = std::min(length_ + keyframes_after, keyframes_.size());
  for (std::size_t i = known; i-- > length_;) passed_.push_back(*keyframes_[i]);
  std::vector<Mended> start;
  for (std::size_t i = length_; i-- > 0;) {
    const auto mended = step_to(*keyframes_[i]);
    if (!mended) return {};
    start.push_back(*mended);
  }
  return start;
}

/// Learns the motion of the camera from the frames after the start, from the last one back.
void WayBack::learn_motion() {
  std::vector<const RegisteredFrame*> frames;
  for (const RegisteredFrame& frame : content_.frames) {
    if (frame.recording != end().recording || frame.index < end().frame_index) continue;
    if (content_.keyframes[frame.keyframe].taken_in != end().taken_in) continue;
    frames.push_back(&frame);
    if (frames.size() == frames_of_motion) break;
  }
  motion_.forget_velocity();
  for (; !frames.empty(); frames.pop_back()) {
    const RegisteredFrame& frame = *frames.back();
    const StampedPose pose{frame.timestamp_s, pose_of(frame, content_.keyframes)};
    if (last_) {
      const int count = std::max(1, last_frame_ - frame.index);
      const Twist change = twist_between(predict(frame.timestamp_s), pose.world_from_camera);
      const Covariance covariance =
          frame.covariance.isZero(0) ? with_shared_errors(Covariance::Zero()) : frame.covariance;
      const Covariance by_surfaces =
          rotated(covariance, content_.keyframes[frame.keyframe].world_from_camera.linear());
      if (before_last_) motion_.note_change(change, by_surfaces, count);
      learn_over(count, by_surfaces.inverse(), motion_);
    }
    pass(pose, frame.index);
  }
  motion_.restart();
}

/// Where constant velocity puts the camera at an earlier time.
Pose WayBack::predict(double timestamp_s) const {
  const double last_step_s = before_last_ ? last_->timestamp_s - before_last_->timestamp_s : 0;
  if (last_step_s == 0) return last_->world_from_camera;
  const double share = (timestamp_s - last_->timestamp_s) / last_step_s;
  return at_constant_velocity(before_last_->world_from_camera, last_->world_from_camera, share);
}

void WayBack::pass(const StampedPose& pose, int frame) {
  before_last_ = last_;
  last_ = pose;
  last_frame_ = frame;
}

/// Registers a keyframe with those after it from where the motion puts it. Empty if it does not fit
/// there.
std::optional<Mended> WayBack::step_to(const Keyframe& keyframe) {
  const int count = std::max(1, last_frame_ - keyframe.frame_index);
  MotionUncertainty expected = motion_;
  learn_over(count, Covariance::Zero(), expected);
  const Covariance by_motion = expected.of_pose();
  constexpr int axes = 3;
  const MotionPrior prior{predict(keyframe.timestamp_s),
                          std::sqrt(by_motion.topLeftCorner<axes, axes>().trace() / axes),
                          std::sqrt(by_motion.bottomRightCorner<axes, axes>().trace() / axes)};
  std::vector<const Keyframe*> around;
  for (const Keyframe& passed : passed_) around.push_back(&passed);
  const auto cloud = keyframe.cloud.load();
  std::vector<RegistrationTarget> targets;
  for (const Keyframe* target :
       choose_targets(*cloud, prior, around, content_.camera, odometry_, registration_)) {
    targets.push_back(target_of(*target));
  }
  const RegistrationResult found =
      register_to_targets(*cloud, targets, content_.camera, prior, registration_);
  if (!succeeded(found.status) || found.inlier_ratio < recognition_.min_inlier_ratio ||
      prior_deviation_sigmas(prior, found.world_from_camera) > odometry_.max_prior_sigmas) {
    return std::nullopt;
  }
  const Covariance information = information_of(found);
  learn_over(count, information, motion_);
  motion_.restart();
  pass({keyframe.timestamp_s, found.world_from_camera}, keyframe.frame_index);
  passed_.erase(passed_.begin());
  passed_.push_back(keyframe);
  passed_.back().world_from_camera = found.world_from_camera;
  return Mended{keyframe.id, found.world_from_camera,
                covariance_of(information + by_motion.inverse())};
}

/// Leaves the poses of frames of the start to smooth_path(): the surfaces held them where they are.
/// Later frames stay where they are, too, beside the first keyframe after the start.
void release_frames(MapContent& content, std::span<const Mended> start, const Keyframe& end) {
  for (RegisteredFrame& frame : content.frames) {
    if (frame.recording != end.recording) continue;
    if (std::ranges::find(start, frame.keyframe, &Mended::id) == start.end()) continue;
    const Keyframe& keyframe = content.keyframes[frame.keyframe];
    frame.constraints.clear();
    if (frame.index == keyframe.frame_index) continue;
    if (frame.index < end.frame_index) {
      frame.covariance = covariance_of(Covariance::Zero());
      continue;
    }
    const Pose end_from_keyframe = end.world_from_camera.inverse() * keyframe.world_from_camera;
    frame.keyframe = end.id;
    frame.keyframe_from_camera = end_from_keyframe * frame.keyframe_from_camera;
    frame.covariance = rotated(frame.covariance, end_from_keyframe.linear());
  }
}

/// Replaces the edges of odometry between keyframes of the start and `end`, the one after it.
void replace_edges(MapContent& content, std::span<const Mended> start, const Keyframe& end) {
  const auto is_of_start = [&](int id) {
    return id == end.id || std::ranges::find(start, id, &Mended::id) != start.end();
  };
  std::erase_if(content.edges, [&](const PoseEdge& edge) {
    return !edge.may_be_wrong && is_of_start(edge.from) && is_of_start(edge.to);
  });
  int next = end.id;
  for (const Mended& mended : start) {
    content.edges.push_back(edge_of(content.keyframes[mended.id], next,
                                    content.keyframes[next].world_from_camera, mended.covariance));
    next = mended.id;
  }
}

}  // namespace

std::vector<int> mend_uncertain_start(MapContent& content, int taken_in,
                                      const OdometryOptions& odometry,
                                      const RegistrationOptions& registration,
                                      const LoopOptions& recognition) {
  WayBack way(content, taken_in, odometry, registration, recognition);
  const std::vector<Mended> start = way.go();
  if (start.empty()) return {};
  release_frames(content, start, way.end());
  std::vector<int> ids;
  for (const Mended& mended : start) {
    content.keyframes.set_pose(mended.id, mended.world_from_camera);
    ids.push_back(mended.id);
  }
  replace_edges(content, start, way.end());
  std::ranges::reverse(ids);
  return ids;
}

}  // namespace tofmap
