// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/path_smoothing.hpp"

#include "recorded_paths.hpp"
#include "registration_choice.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tofmap {
namespace {

using Twist = MotionUncertainty::Twist;
using Covariance = MotionUncertainty::Covariance;
/// What is to be found: the correction of a frame, and that of the frame before it.
using State = Eigen::Matrix<double, 12, 1>;
using Joint = Eigen::Matrix<double, 12, 12>;

/// Standard deviation, in metres and radians, to which the poses of keyframes are held.
constexpr double held_sigma = 1e-4;

/// Frames are smoothed together with this many before and after them, and so many at once, since
/// estimates take 2.5 KB a frame.
constexpr std::size_t frames_beside = 100;
constexpr std::size_t frames_at_once = 1000;

/// A frame of the path.
struct Step {
  RegisteredFrame* frame = nullptr;
  Pose world_from_camera = Pose::Identity();
  bool is_held = false;
  Covariance by_surfaces = Covariance::Zero();  ///< along the axes of the world
};

/// What is known of a frame and of the one before it.
struct Estimate {
  double share = 0;  ///< time since the frame before, as a share of the time before that
  State expected = State::Zero();  ///< from the frames before
  Joint of_expected = Joint::Zero();
  State known = State::Zero();  ///< from this frame, in the end also from those after it
  Joint of_known = Joint::Zero();

  /// Adds that the surfaces know of no correction.
  void use(const Covariance& by_surfaces);
};

void make_symmetric(Joint& covariance) {
  covariance = (0.5 * (covariance + covariance.transpose())).eval();
}

void Estimate::use(const Covariance& by_surfaces) {
  const Covariance sum = of_expected.topLeftCorner<6, 6>() + by_surfaces;
  const Eigen::Matrix<double, 6, 12> transposed_gain =
      sum.ldlt().solve(Eigen::Matrix<double, 6, 12>(of_expected.topRows<6>()));
  known = expected - transposed_gain.transpose() * expected.head<6>();
  of_known = of_expected - transposed_gain.transpose() * sum * transposed_gain;
  make_symmetric(of_known);
}

/// The state of a frame from that of the one before it, with constant velocity.
Joint constant_velocity(double share) {
  Joint next = Joint::Zero();
  next.topLeftCorner<6, 6>().diagonal().setConstant(1 + share);
  next.topRightCorner<6, 6>().diagonal().setConstant(-share);
  next.bottomLeftCorner<6, 6>().setIdentity();
  return next;
}

/// The estimate of the first frame of a path. The camera may already move.
Estimate first_estimate(const Step& step) {
  Estimate estimate;
  estimate.of_expected.setIdentity();  // metres and radians
  estimate.use(step.by_surfaces);
  return estimate;
}

/// The estimate of the second frame, or of the last of three. Learns of the motion.
Estimate next_estimate(const Estimate& before, std::span<const Step> steps,
                       MotionUncertainty& motion) {
  const Step& step = steps.back();
  Estimate estimate;
  Twist change = Twist::Zero();
  Twist sigmas = Twist::Ones();
  if (steps.size() > 2) {
    const double last_step_s = steps[1].frame->timestamp_s - steps[0].frame->timestamp_s;
    estimate.share = (step.frame->timestamp_s - steps[1].frame->timestamp_s) / last_step_s;
    change = twist_between(at_constant_velocity(steps[0].world_from_camera,
                                                steps[1].world_from_camera, estimate.share),
                           step.world_from_camera);
    sigmas = std::max(1.0, estimate.share) * motion.change_sigmas();
    motion.note_change(change, step.by_surfaces, 1);
  }
  const Joint next = constant_velocity(estimate.share);
  estimate.expected = next * before.known;
  estimate.expected.head<6>() -= change;
  estimate.of_expected = next * before.of_known * next.transpose();
  estimate.of_expected.topLeftCorner<6, 6>().diagonal() += sigmas.cwiseAbs2();
  estimate.use(step.by_surfaces);
  return estimate;
}

/// Adds what the frames after it tell to an estimate.
void smooth(Estimate& estimate, const Estimate& after) {
  const Joint transposed_gain =
      after.of_expected.ldlt().solve(Joint(constant_velocity(after.share) * estimate.of_known));
  estimate.known += transposed_gain.transpose() * (after.known - after.expected);
  estimate.of_known +=
      transposed_gain.transpose() * (after.of_known - after.of_expected) * transposed_gain;
  make_symmetric(estimate.of_known);
}

std::vector<Estimate> smoothed(std::span<const Step> steps, MotionUncertainty motion) {
  std::vector<Estimate> estimates{first_estimate(steps.front())};
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const std::size_t first = i - std::min<std::size_t>(i, 2);
    estimates.push_back(
        next_estimate(estimates.back(), steps.subspan(first, i + 1 - first), motion));
  }
  for (std::size_t i = estimates.size() - 1; i-- > 0;) smooth(estimates[i], estimates[i + 1]);
  return estimates;
}

/// The covariance of what two measurements, of which each may be missing, tell on average.
Covariance mean_of(const Step* one, const Step* other) {
  if (one == nullptr || other == nullptr) return (one ? one : other)->by_surfaces;
  return 2 * (one->by_surfaces.inverse() + other->by_surfaces.inverse()).inverse();
}

/// From one frame to the next, a camera sees nearly the same. If the surfaces hold a frame in a
/// direction in which they do not hold those beside it, it has probably been deceived: a few edges
/// were taken for others. So a frame is as certain as those beside it, but for a factor.
void distrust_lone_certainty(std::span<Step> path) {
  constexpr double most_times_more_certain = 5;
  const auto frame_at = [&](std::size_t i) {
    return i < path.size() && !path[i].is_held ? &path[i] : nullptr;
  };
  std::vector<Covariance> beside;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Step* before = frame_at(i - 1);
    const Step* after = frame_at(i + 1);
    const bool is_alone = path[i].is_held || (before == nullptr && after == nullptr);
    beside.push_back(is_alone ? Covariance(Covariance::Zero()) : mean_of(before, after));
  }
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i].by_surfaces += beside[i] / (most_times_more_certain * most_times_more_certain);
  }
}

std::vector<Step> steps_of(MapContent& content, std::span<const std::size_t> path) {
  std::vector<Step> steps;
  for (const std::size_t index : path) {
    RegisteredFrame& frame = content.frames[index];
    Step& step = steps.emplace_back();
    step.frame = &frame;
    step.world_from_camera = pose_of(frame, content.keyframes);
    step.is_held = is_of_keyframe(frame, content.keyframes);
    step.by_surfaces = step.is_held
                           ? Covariance(held_sigma * held_sigma * Covariance::Identity())
                           : rotated(frame.covariance,
                                     content.keyframes[frame.keyframe].world_from_camera.linear());
  }
  return steps;
}

void correct(const Step& step, const Estimate& estimate, const KeyframeGraph& keyframes) {
  if (step.is_held) return;
  const Pose keyframe_from_world = keyframes[step.frame->keyframe].world_from_camera.inverse();
  step.frame->keyframe_from_camera =
      keyframe_from_world * moved_by(estimate.known.head<6>(), step.world_from_camera);
  step.frame->covariance =
      rotated(estimate.of_known.topLeftCorner<6, 6>(), keyframe_from_world.linear());
}

}  // namespace

void smooth_path(MapContent& content, int recording, const MotionUncertainty& motion) {
  for (const std::vector<std::size_t>& indices : recorded_paths(content, recording)) {
    std::vector<Step> path = steps_of(content, indices);
    distrust_lone_certainty(path);
    for (std::size_t begin = 0; begin < path.size(); begin += frames_at_once) {
      const std::size_t end = std::min(begin + frames_at_once, path.size());
      const std::size_t before = begin - std::min(begin, frames_beside);
      const std::size_t after = std::min(end + frames_beside, path.size());
      const std::vector<Estimate> estimates =
          smoothed(std::span(path).subspan(before, after - before), motion);
      for (std::size_t i = begin; i < end; ++i) {
        correct(path[i], estimates[i - before], content.keyframes);
      }
    }
  }
}

}  // namespace tofmap
