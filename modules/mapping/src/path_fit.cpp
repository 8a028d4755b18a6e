// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/path_fit.hpp"

#include "correction_system.hpp"
#include "motion_terms.hpp"
#include "recorded_paths.hpp"
#include "relative_measurement.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/robust_kernel.hpp>

namespace tofmap {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// How far a frame may be from where it is relative to its keyframe, as standard deviations. It
/// holds frames that have no constraints.
constexpr double frame_rotation_sigma_rad = 0.03;
constexpr double frame_translation_sigma_m = 0.1;

/// By what the standard deviations of odometry are multiplied: its edges are from registrations
/// that are among the constraints already.
constexpr double odometry_sigmas = 5;

/// Whether a change of the relative pose of an edge, along the axes of `from`, is within what its
/// registration left open.
bool is_expected(const Vector6d& change, const PoseEdge& edge) {
  constexpr double most_sigmas = 4;
  return change.dot(edge.covariance.ldlt().solve(change)) <= most_sigmas * most_sigmas;
}

/// The problem at the present poses.
class PathFit {
 public:
  PathFit(MapContent& content, int recording, const LoopOptions& options,
          const MotionUncertainty& motion, std::size_t held);

  /// Corrects all poses once. False if they are not determined.
  bool step();

  /// Sets the relative poses of edges of odometry to those of the present poses.
  void correct_edges();

 private:
  const Keyframe& at(int id) const { return content_.keyframes[id]; }
  bool is_keyframe(const RegisteredFrame& frame) const {
    return is_of_keyframe(frame, content_.keyframes);
  }
  bool is_fitted(const RegisteredFrame& frame) const {
    return frame.recording == recording_ || static_cast<std::size_t>(frame.keyframe) >= held_;
  }
  /// Whether the registration that an edge of odometry is from is among the constraints.
  bool is_counted(const PoseEdge& edge) const {
    return constrained_.contains({edge.to, edge.from}) ||
           constrained_.contains({edge.from, edge.to});
  }
  int& pose_number(const RegisteredFrame& frame) {
    return pose_numbers_[static_cast<std::size_t>(&frame - content_.frames.data())];
  }
  void find_motion();
  void leave_out_far_constraints();
  const Pose& pose_of_keyframe(int id) const { return at(id).world_from_camera; }
  std::vector<RelativeTerm> terms_of(const RegisteredFrame& frame, const Pose& pose) const;
  Matrix6d weighted_information(const PoseEdge& edge) const;
  void add_edges(CorrectionSystem& system) const;
  void add_frames(CorrectionSystem& system);
  void add_motion(CorrectionSystem& system) const;
  std::optional<Vector6d> correction_of(const RegisteredFrame& frame,
                                        const Eigen::VectorXd& corrections);

  MapContent& content_;
  int recording_;
  const LoopOptions& options_;
  const MotionUncertainty& motion_;
  std::size_t held_;
  std::vector<bool> is_held_;  ///< for each pose in the system, whether it stays where it is
  /// Keyframes with those that their frames have constraints with.
  std::set<std::pair<int, int>> constrained_;
  std::set<const FrameConstraint*> left_out_;
  std::vector<MotionTerm> motion_terms_;  ///< at the present poses
  /// For each frame, its pose in the system; −1 if it is eliminated, or not in it.
  std::vector<int> pose_numbers_;
};

PathFit::PathFit(MapContent& content, int recording, const LoopOptions& options,
                 const MotionUncertainty& motion, std::size_t held)
    : content_(content), recording_(recording), options_(options), motion_(motion), held_(held) {
  std::set<int> begun;
  for (const Keyframe& keyframe : content_.keyframes.all()) {
    const bool is_first = begun.insert(keyframe.map).second;
    is_held_.push_back(is_first || static_cast<std::size_t>(keyframe.id) < held);
  }
  leave_out_far_constraints();
  for (const RegisteredFrame& frame : content_.frames) {
    if (!is_keyframe(frame)) continue;
    for (const FrameConstraint& constraint : frame.constraints) {
      if (!left_out_.contains(&constraint)) {
        constrained_.insert({frame.keyframe, constraint.keyframe});
      }
    }
  }
}

/// Leaves constraints out by the poses before the fit: along directions that nothing determined,
/// the motion may move poses farther.
void PathFit::leave_out_far_constraints() {
  for (const RegisteredFrame& frame : content_.frames) {
    if (!is_fitted(frame)) continue;
    const Pose pose = pose_of(frame, content_.keyframes);
    for (const FrameConstraint& constraint : frame.constraints) {
      if (!is_small(error_of(measured_by(constraint), pose_of_keyframe(constraint.keyframe), pose)))
        left_out_.insert(&constraint);
    }
  }
}

/// Finds the terms of the motion at the present poses, and numbers the poses of their frames.
void PathFit::find_motion() {
  std::set<int> recordings;
  for (const RegisteredFrame& frame : content_.frames) {
    if (is_fitted(frame)) recordings.insert(frame.recording);
  }
  motion_terms_.clear();
  for (const int recording : recordings) {
    std::ranges::move(motion_terms(content_, recording, motion_),
                      std::back_inserter(motion_terms_));
  }
  pose_numbers_.assign(content_.frames.size(), -1);
  int poses = content_.keyframes.size();
  for (const MotionTerm& term : motion_terms_) {
    for (const std::size_t index : term.frames) {
      const RegisteredFrame& frame = content_.frames[index];
      int& number = pose_number(frame);
      if (number < 0) number = is_keyframe(frame) ? frame.keyframe : poses++;
    }
  }
  is_held_.resize(static_cast<std::size_t>(poses), false);
}

/// The terms of a frame at a pose.
std::vector<RelativeTerm> PathFit::terms_of(const RegisteredFrame& frame, const Pose& pose) const {
  std::vector<RelativeTerm> terms;
  for (const FrameConstraint& constraint : frame.constraints) {
    const bool is_of_another_map = at(constraint.keyframe).map != at(frame.keyframe).map;
    if (is_of_another_map || left_out_.contains(&constraint)) continue;
    terms.push_back(term_of(measured_by(constraint), pose_of_keyframe(constraint.keyframe), pose));
  }
  if (is_keyframe(frame)) return terms;
  Vector6d sigmas;
  sigmas << Eigen::Vector3d::Constant(frame_rotation_sigma_rad),
      Eigen::Vector3d::Constant(frame_translation_sigma_m);
  terms.push_back(term_of(
      {frame.keyframe, frame.keyframe_from_camera, sigmas.cwiseAbs2().cwiseInverse().asDiagonal()},
      pose_of_keyframe(frame.keyframe), pose));
  return terms;
}

/// The information of an edge by which it counts here.
Matrix6d PathFit::weighted_information(const PoseEdge& edge) const {
  const Matrix6d information = edge.covariance.inverse();
  if (edge.may_be_wrong) {
    const Vector6d error =
        rotated_twist(error_of({edge.from, edge.from_from_to, information},
                               pose_of_keyframe(edge.from), pose_of_keyframe(edge.to)),
                      pose_of_keyframe(edge.from).linear().transpose());
    return geman_mcclure_weight_of_squares(error.dot(information * error),
                                           options_.kernel_width * options_.kernel_width) *
           information;
  }
  return is_counted(edge) ? information / (odometry_sigmas * odometry_sigmas) : information;
}

void PathFit::add_edges(CorrectionSystem& system) const {
  auto loop = content_.loops.begin();
  for (const PoseEdge& edge : content_.edges) {
    const bool is_used = !edge.may_be_wrong || (loop++)->is_used;
    if (!is_used || at(edge.from).map != at(edge.to).map) continue;
    system.add(edge.to, term_of({edge.from, edge.from_from_to, weighted_information(edge)},
                                pose_of_keyframe(edge.from), pose_of_keyframe(edge.to)));
  }
}

void PathFit::add_frames(CorrectionSystem& system) {
  for (const RegisteredFrame& frame : content_.frames) {
    if (!is_fitted(frame)) continue;  // tells nothing new
    const std::vector<RelativeTerm> terms = terms_of(frame, pose_of(frame, content_.keyframes));
    const int pose = is_keyframe(frame) ? frame.keyframe : pose_number(frame);
    if (pose >= 0) {
      for (const RelativeTerm& term : terms) system.add(pose, term);
    } else if (const FrameEquations equations(terms); equations.are_regular()) {
      system.add_frame(terms, equations);
    }
  }
}

void PathFit::add_motion(CorrectionSystem& system) const {
  for (const MotionTerm& term : motion_terms_) {
    std::array<int, 3> poses = {};
    std::ranges::transform(term.frames, poses.begin(),
                           [&](std::size_t frame) { return pose_numbers_[frame]; });
    system.add_motion(poses, term);
  }
}

/// The correction of a frame that is not a keyframe. Empty if nothing determines it.
std::optional<Vector6d> PathFit::correction_of(const RegisteredFrame& frame,
                                               const Eigen::VectorXd& corrections) {
  if (const int pose = pose_number(frame); pose >= 0) return corrections.segment<6>(6 * pose);
  const std::vector<RelativeTerm> terms = terms_of(frame, pose_of(frame, content_.keyframes));
  const FrameEquations equations(terms);
  if (!equations.are_regular()) return std::nullopt;
  return frame_correction(terms, equations, corrections);
}

bool PathFit::step() {
  find_motion();
  CorrectionSystem system(is_held_);
  add_edges(system);
  add_frames(system);
  add_motion(system);
  const auto corrections = system.solve();
  if (!corrections) return false;
  for (RegisteredFrame& frame : content_.frames) {
    if (frame.recording != recording_ || is_keyframe(frame)) continue;
    const auto correction = correction_of(frame, *corrections);
    if (!correction) continue;
    const Pose world_from_keyframe =
        moved_by(corrections->segment<6>(6 * frame.keyframe), at(frame.keyframe).world_from_camera);
    frame.keyframe_from_camera =
        world_from_keyframe.inverse() * moved_by(*correction, pose_of(frame, content_.keyframes));
  }
  for (int id = 0; id < content_.keyframes.size(); ++id) {
    if (is_held_[static_cast<std::size_t>(id)]) continue;
    content_.keyframes.set_pose(
        id, moved_by(corrections->segment<6>(6 * id), at(id).world_from_camera));
  }
  return true;
}

void PathFit::correct_edges() {
  for (PoseEdge& edge : content_.edges) {
    const auto later = static_cast<std::size_t>(std::max(edge.from, edge.to));
    if (edge.may_be_wrong || later < held_ || !is_counted(edge)) continue;
    const Pose found = pose_of_keyframe(edge.from).inverse() * pose_of_keyframe(edge.to);
    const Vector6d change = twist_between(edge.from_from_to, found);
    if (is_small(change) || is_expected(change, edge)) edge.from_from_to = found;
  }
}

}  // namespace

void fit_path(MapContent& content, int recording, const LoopOptions& options,
              const MotionUncertainty& motion, std::size_t held) {
  constexpr int steps = 2;  // the problem is nearly linear
  PathFit fit(content, recording, options, motion, held);
  for (int i = 0; i < steps; ++i) {
    if (!fit.step()) break;
  }
  fit.correct_edges();
}

}  // namespace tofmap
