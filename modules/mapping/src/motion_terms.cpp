// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "motion_terms.hpp"

#include "recorded_paths.hpp"
#include "registration_choice.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

namespace tofmap {
namespace {

using Twist = MotionUncertainty::Twist;
using Covariance = MotionUncertainty::Covariance;

/// The motion through an uncertain frame is known from this many frames before and after it.
constexpr std::size_t frames_around = 5;

/// For each keyframe, what surfaces tell of its pose at its most certain edge of odometry: a
/// covariance along the axes of the world. Zero for the first one of a map.
std::vector<Covariance> covariances_of_keyframes(const MapContent& content) {
  const auto count = static_cast<std::size_t>(content.keyframes.size());
  std::vector<Covariance> covariances(count, Covariance::Zero());
  std::vector<double> least(count, std::numeric_limits<double>::infinity());
  for (const PoseEdge& edge : content.edges) {
    const auto to = static_cast<std::size_t>(edge.to);
    const double spread_m2 = spread_of(edge.covariance).translation_m2;
    if (edge.may_be_wrong || spread_m2 >= least[to]) continue;
    least[to] = spread_m2;
    covariances[to] =
        rotated(edge.covariance, content.keyframes[edge.from].world_from_camera.linear());
  }
  return covariances;
}

bool is_more_uncertain(const Covariance& by_surfaces, const Twist& sigmas) {
  const PoseSpread spread = spread_of(by_surfaces);
  return spread.rotation_sigma_rad() > sigmas.head<3>().minCoeff() ||
         spread.translation_sigma_m() > sigmas.tail<3>().minCoeff();
}

/// The motion along one path.
class PathMotion {
 public:
  PathMotion(const MapContent& content, std::span<const std::size_t> path,
             const std::vector<Covariance>& of_keyframes, MotionUncertainty motion);

  /// The terms around uncertain frames.
  std::vector<MotionTerm> terms() const;

 private:
  MotionTerm term(std::size_t i) const;

  const MapContent& content_;
  std::span<const std::size_t> path_;
  std::vector<MotionTerm> all_;  ///< of each frame from the third one on
  std::vector<bool> is_uncertain_;
};

/// The term of a frame and the two before it, as if the surfaces knew its pose.
MotionTerm PathMotion::term(std::size_t i) const {
  MotionTerm term{.frames = {path_[i - 2], path_[i - 1], path_[i]}};
  const auto frame = [&](std::size_t k) -> const RegisteredFrame& {
    return content_.frames[term.frames[k]];
  };
  term.share =
      (frame(2).timestamp_s - frame(1).timestamp_s) / (frame(1).timestamp_s - frame(0).timestamp_s);
  term.change =
      twist_between(at_constant_velocity(pose_of(frame(0), content_.keyframes),
                                         pose_of(frame(1), content_.keyframes), term.share),
                    pose_of(frame(2), content_.keyframes));
  return term;
}

PathMotion::PathMotion(const MapContent& content, std::span<const std::size_t> path,
                       const std::vector<Covariance>& of_keyframes, MotionUncertainty motion)
    : content_(content), path_(path) {
  for (std::size_t i = 0; i < path.size(); ++i) {
    const RegisteredFrame& frame = content.frames[path[i]];
    const auto& keyframe = content.keyframes[frame.keyframe];
    const Covariance by_surfaces =
        is_of_keyframe(frame, content.keyframes)
            ? of_keyframes[static_cast<std::size_t>(frame.keyframe)]
            : rotated(frame.covariance, keyframe.world_from_camera.linear());
    is_uncertain_.push_back(is_more_uncertain(by_surfaces, motion.change_sigmas()));
    if (i < 2) continue;
    MotionTerm& found = all_.emplace_back(term(i));
    found.sigmas = std::max(1.0, found.share) * motion.change_sigmas();
    motion.note_change(found.change, by_surfaces, 1);
  }
}

std::vector<MotionTerm> PathMotion::terms() const {
  std::vector<MotionTerm> terms;
  for (std::size_t i = 2; i < path_.size(); ++i) {
    const auto begin =
        is_uncertain_.begin() + static_cast<std::ptrdiff_t>(i - 2 - std::min(i - 2, frames_around));
    const auto end = is_uncertain_.begin() +
                     static_cast<std::ptrdiff_t>(std::min(i + 1 + frames_around, path_.size()));
    if (std::find(begin, end, true) != end) terms.push_back(all_[i - 2]);
  }
  return terms;
}

}  // namespace

std::vector<MotionTerm> motion_terms(const MapContent& content, int recording,
                                     const MotionUncertainty& motion) {
  const std::vector<Covariance> of_keyframes = covariances_of_keyframes(content);
  std::vector<MotionTerm> terms;
  for (const std::vector<std::size_t>& path : recorded_paths(content, recording)) {
    std::ranges::move(PathMotion(content, path, of_keyframes, motion).terms(),
                      std::back_inserter(terms));
  }
  return terms;
}

}  // namespace tofmap
