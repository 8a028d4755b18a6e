// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap::kinect2 {

// A Kinect v2 sends images that are mirrored: their left end is the right end of what the camera
// sees (libfreenect2 issue 172). libfreenect2 leaves them so, and the camera's intrinsics and P0
// tables are for the mirrored images. Without mirroring them back, every map would be a mirror
// image of the building. Images, camera and light source must be mirrored together.

/// An image with its columns in reverse order.
template <class T>
Image<T> mirrored(const Image<T>& image) {
  return image.rowwise().reverse();
}

/// The camera that sees what `camera` sees, mirrored: with columns in reverse order. A light source
/// at (x, y, z) in the frame of `camera` is at (-x, y, z) in that of the result.
CameraModel mirrored(const CameraModel& camera);

}  // namespace tofmap::kinect2
