// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/frame_constraint.hpp"

#include <algorithm>
#include <cstddef>

#include <tofmap/registration/pose_graph.hpp>

namespace tofmap {

std::vector<FrameConstraint> constraints_of(const RegistrationResult& registration,
                                            std::span<const Keyframe* const> keyframes) {
  std::vector<FrameConstraint> constraints;
  const auto& equations = registration.target_equations;
  for (std::size_t i = 0; i < std::min(keyframes.size(), equations.size()); ++i) {
    const Pose keyframe_from_world = keyframes[i]->world_from_camera.inverse();
    const Eigen::Matrix3d axes = keyframe_from_world.linear();
    const Pose keyframe_from_camera = keyframe_from_world * registration.world_from_camera;
    constraints.push_back(
        {.keyframe = keyframes[i]->id,
         .keyframe_from_camera = Eigen::Isometry3f(keyframe_from_camera.cast<float>()),
         .information = rotated(equations[i].information, axes).cast<float>(),
         .gradient = rotated_twist(equations[i].gradient, axes).cast<float>()});
  }
  return constraints;
}

}  // namespace tofmap
