// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/mapping/verification.hpp"

#include "tofmap/mapping/free_space.hpp"

#include <algorithm>

namespace tofmap {

RegistrationResult register_from_afar(const SurfaceCloud& cloud,
                                      std::span<const RegistrationTarget> targets,
                                      const CameraModel& camera, const MotionPrior& prior,
                                      const RegistrationOptions& registration) {
  constexpr double max_distance_m = 1;
  constexpr int iterations = 40;
  RegistrationOptions wide = registration;
  wide.max_correspondence_distance_m =
      std::max(registration.max_correspondence_distance_m,
               std::min(max_distance_m, 2 * prior.translation_sigma_m));
  wide.max_iterations = std::max(registration.max_iterations, iterations);
  MotionPrior closer = prior;
  closer.world_from_camera =
      register_to_targets(cloud, targets, camera, prior, wide).world_from_camera;
  return register_to_targets(cloud, targets, camera, closer, registration);
}

double support(const RegistrationResult& result) {
  return succeeded(result.status) ? result.overlap * result.inlier_ratio : 0;
}

bool is_verified(const RegistrationResult& result, const LoopOptions& options) {
  return result.status == RegistrationStatus::converged && result.overlap >= options.min_overlap &&
         result.inlier_ratio >= options.min_inlier_ratio && result.degenerate_directions == 0;
}

bool confirms_place(const Keyframe& keyframe, const SurfaceCloud& cloud,
                    const RegistrationResult& result, const CameraModel& camera,
                    const LoopOptions& options, bool is_of_one_recording) {
  return is_verified(result, options) &&
         !contradicts_free_space({&cloud, result.world_from_camera}, target_of(keyframe), camera,
                                 is_of_one_recording ? most_violations : most_violations_since);
}

}  // namespace tofmap
