// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tofmap/acquisition/kinect2/intrinsics.hpp"

#include <tofmap/acquisition/kinect2/packet.hpp>

namespace tofmap::kinect2 {
namespace {

constexpr double first_centre_px = 0.5;

}  // namespace

bool is_possible_focal_length(double focal_length_px) {
  return focal_length_px >= 200 && focal_length_px <= 600;
}

CameraModel camera_of(const Intrinsics& intrinsics) {
  const auto& [fx, fy, cx, cy, k1, k2, k3, p1, p2] = intrinsics;
  return {.width_px = image_width_px,
          .height_px = image_height_px,
          .fx_px = fx,
          .fy_px = fy,
          .cx_px = cx - first_centre_px,
          .cy_px = cy - first_centre_px,
          .distortion = {k1, k2, p1, p2, k3}};
}

Intrinsics intrinsics_of(const CameraModel& camera) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  return {.fx = camera.fx_px,
          .fy = camera.fy_px,
          .cx = camera.cx_px + first_centre_px,
          .cy = camera.cy_px + first_centre_px,
          .k1 = k1,
          .k2 = k2,
          .k3 = k3,
          .p1 = p1,
          .p2 = p2};
}

}  // namespace tofmap::kinect2
