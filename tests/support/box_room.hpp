// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "box_ranges.hpp"

#include <tofmap/cloud/surface_cloud.hpp>

namespace tofmap::test {

inline SurfaceCloud box_cloud(const CameraModel& camera, const Eigen::Vector3d& min,
                              const Eigen::Vector3d& max, const Pose& world_from_camera) {
  return surface_cloud(box_ranges(camera, min, max, world_from_camera), pixel_rays(camera), {});
}

}  // namespace tofmap::test
