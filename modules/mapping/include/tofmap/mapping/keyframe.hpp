// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/keyframe_cloud.hpp>
#include <tofmap/mapping/place_descriptor.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A frame that is kept, and that later frames are registered with.
struct Keyframe {
  int id = 0;           ///< numbered from 0, without gaps; in the order of time in a recording
  int frame_index = 0;  ///< index of the frame in the recording
  double timestamp_s = 0;
  Pose world_from_camera = Pose::Identity();
  KeyframeCloud cloud = {};    ///< in the camera's frame; not empty
  double path_m = 0;           ///< length of the path through all keyframes up to this one
  PlaceDescriptor place = {};  ///< of the cloud
  int map = 0;                 ///< the map that the pose refers to; see RoomMapper
  int taken_in = 0;            ///< the map it was taken in, before any join
  int recording = 0;           ///< index of the recording in MapContent::recordings
};

/// Largest number of maps, joined or not, that a run may begin.
inline constexpr int most_maps = 1 << 20;

/// A keyframe as a target of registration, which keeps its cloud in memory. Throws InputError as
/// KeyframeCloud::load() does.
RegistrationTarget target_of(const Keyframe& keyframe);

/// A keyframe and the ones directly before and after it, if they are of the same map, as targets.
/// `keyframes` are in the order of their ids, from 0.
std::vector<RegistrationTarget> targets_around(const Keyframe& keyframe,
                                               std::span<const Keyframe> keyframes);

/// The `most` keyframes whose descriptors differ least from `place`, most similar first. All
/// keyframes if there are fewer.
std::vector<const Keyframe*> most_alike(const PlaceDescriptor& place,
                                        std::vector<const Keyframe*> keyframes, std::size_t most);

}  // namespace tofmap
