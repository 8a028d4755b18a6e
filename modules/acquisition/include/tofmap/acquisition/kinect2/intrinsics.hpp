// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>

namespace tofmap::kinect2 {

/// The intrinsics of the infrared camera as libfreenect2 and its recordings have them. They belong
/// to images whose columns are as the camera sends them. The names are those of OpenCV's model, but
/// the centre of the first pixel is at (0.5, 0.5), as libfreenect2's depth tables have it.
struct Intrinsics {
  double fx = 0;
  double fy = 0;
  double cx = 0;
  double cy = 0;
  double k1 = 0;
  double k2 = 0;
  double k3 = 0;
  double p1 = 0;
  double p2 = 0;
};

/// The intrinsics of one Kinect v2 that have been copied from program to program, among them
/// Processing's Kinect examples, for packets that come without the intrinsics of their own camera.
/// Those of other cameras differ. libfreenect2 itself has no defaults, as it asks the camera.
inline constexpr Intrinsics typical_intrinsics{.fx = 365.456,
                                               .fy = 365.456,
                                               .cx = 254.878,
                                               .cy = 205.395,
                                               .k1 = 0.0905474,
                                               .k2 = -0.26819,
                                               .k3 = 0.0950862,
                                               .p1 = 0,
                                               .p2 = 0};

/// Whether a Kinect v2 can have this focal length, 200 … 600 pixels. All of them have the same
/// lens, with about 365.
bool is_possible_focal_length(double focal_length_px);

/// The camera with these intrinsics. Its principal point is (cx - 0.5, cy - 0.5), because the
/// centre of the first pixel of a CameraModel is at (0, 0).
CameraModel camera_of(const Intrinsics& intrinsics);

/// The intrinsics of a camera: the inverse of camera_of().
Intrinsics intrinsics_of(const CameraModel& camera);

}  // namespace tofmap::kinect2
