// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include <tofmap/cloud/surface_cloud.hpp>
#include <tofmap/core/trajectory.hpp>
#include <tofmap/registration/projective_icp.hpp>

namespace tofmap {

/// A frame that later frames are registered against.
struct Keyframe {
  int id = 0;  ///< keyframes are numbered from 0, without gaps, in the order of time
  int frame_index = 0;
  double timestamp_s = 0;
  Pose world_from_camera = Pose::Identity();
  std::shared_ptr<const SurfaceCloud> cloud;  ///< in the camera's frame
};

/// A keyframe as frames are registered against it; it must outlive the target.
inline RegistrationTarget target_of(const Keyframe& keyframe) {
  return {keyframe.cloud.get(), keyframe.world_from_camera};
}

}  // namespace tofmap
