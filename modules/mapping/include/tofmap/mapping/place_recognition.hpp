// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/mapping/keyframe.hpp>
#include <tofmap/mapping/loop_options.hpp>
#include <tofmap/registration/pose_graph.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// How far a camera may be from a keyframe that recognises it: the standard deviations of the prior
/// of register_near().
inline constexpr double recognition_reach_m = 0.5;
inline constexpr double recognition_reach_rad = 0.35;

/// Registers a cloud with a keyframe and the keyframes directly before and after it, from the pose
/// of that keyframe (register_from_afar()).
RegistrationResult register_near(const Keyframe& keyframe, const SurfaceCloud& cloud,
                                 std::span<const Keyframe> keyframes, const CameraModel& camera,
                                 const RegistrationOptions& registration);

/// A place that was recognised: the pose of a keyframe in the map of another one, found without
/// knowledge of the camera's motion.
struct Recognition {
  int from = 0;                     ///< id of the keyframe that the place was recognised by
  RegistrationResult registration;  ///< with that keyframe and its neighbours, in their map
};

/// Whether the camera of a keyframe can have been at a pose in the map of a candidate.
using IsPossiblePlace = std::function<bool(const Keyframe& candidate, const Pose& pose)>;

/// The places among other keyframes that a keyframe may see.
///
/// The keyframe is registered with each of the five candidates that look most similar and, if these
/// are of other recordings, with up to five at other places, from the pose of that candidate
/// (register_near()). A result counts if the place is possible and the
/// candidate confirms it (confirms_place()). `keyframes` are all keyframes in the order of their
/// ids, from 0, and must outlive the candidates, which are some of them.
std::vector<Recognition> find_places(const Keyframe& keyframe,
                                     std::vector<const Keyframe*> candidates,
                                     const IsPossiblePlace& is_possible,
                                     std::span<const Keyframe> keyframes, const CameraModel& camera,
                                     const LoopOptions& options,
                                     const RegistrationOptions& registration);

/// The place with the largest product of overlap and inlier ratio. Empty if there is none, or if
/// another place reaches more than 90 % of that product.
std::optional<Recognition> surest_place(std::vector<Recognition> places,
                                        std::span<const Keyframe> keyframes);

/// The places of other maps that a keyframe may see, as edges from the keyframes that it was
/// registered with.
struct RecognisedPlaces {
  std::vector<PoseEdge> possible;  ///< find_places()
  std::optional<PoseEdge> surest;  ///< surest_place() of them
};

/// Recognises places as find_places() does.
RecognisedPlaces recognise_places(const Keyframe& keyframe, std::vector<const Keyframe*> candidates,
                                  const IsPossiblePlace& is_possible,
                                  std::span<const Keyframe> keyframes, const CameraModel& camera,
                                  const LoopOptions& options,
                                  const RegistrationOptions& registration);

}  // namespace tofmap
