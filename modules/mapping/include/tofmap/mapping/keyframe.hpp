// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/mapping/place_descriptor.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A frame that later frames are registered against.
struct Keyframe {
  int id = 0;  ///< keyframes are numbered from 0, without gaps, in the order of time
  int frame_index = 0;
  double timestamp_s = 0;
  Pose world_from_camera = Pose::Identity();
  std::shared_ptr<const SurfaceCloud> cloud = {};  ///< in the camera's frame
  double path_m = 0;                               ///< how far the camera has come
  PlaceDescriptor place = {};                      ///< of the cloud
};

/// A keyframe as frames are registered against it; it must outlive the target.
inline RegistrationTarget target_of(const Keyframe& keyframe) {
  return {keyframe.cloud.get(), keyframe.world_from_camera};
}

/// A keyframe with those before and after it, as targets.
std::vector<RegistrationTarget> targets_around(const Keyframe& keyframe,
                                               std::span<const Keyframe> keyframes);

/// So many of the keyframes that look most like a place, the most alike first.
std::vector<const Keyframe*> most_alike(const PlaceDescriptor& place,
                                        std::vector<const Keyframe*> keyframes, std::size_t most);

}  // namespace tofmap
