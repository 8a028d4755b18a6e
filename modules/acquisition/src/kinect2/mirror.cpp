// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/mirror.hpp"

namespace tofmap::kinect2 {

CameraModel mirrored(const CameraModel& camera) {
  CameraModel result = camera;
  result.cx_px = camera.width_px - 1 - camera.cx_px;
  constexpr std::size_t p2 = 3;  // of k1 k2 p1 p2 k3: the only coefficient that is odd in x
  result.distortion[p2] = -camera.distortion[p2];
  return result;
}

}  // namespace tofmap::kinect2
