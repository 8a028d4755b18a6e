// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// A picture of the cloud of one frame, without unwrapping (top row) and with unwrapping (bottom
/// row), seen from the left behind the camera (left) and from above (right), as in figures 11 and
/// 12 of the paper. Points with a wrap count above 0 are red in both rows. `wrapped_m` holds ranges
/// in metres and has the size of `unwrapped`. Throws DrawingError if this machine cannot draw.
Picture cloud_picture(const RangeImage& unwrapped, const ImageF& wrapped_m, const PixelRays& rays);

/// The points of a range image in the camera frame, with an outline of the camera. `range_m` holds
/// radial ranges in metres; NaN pixels are left out. `color` returns the colour of the point of a
/// pixel.
Drawing frame_drawing(const ImageF& range_m, const PixelRays& rays,
                      const std::function<Rgb(Eigen::Index row, Eigen::Index col)>& color);

/// The points of a range image that belongs to an unwrapped image, coloured as in cloud_picture().
/// Pixels without a wrap count are left out.
Drawing frame_drawing(const RangeImage& unwrapped, const ImageF& range_m, const PixelRays& rays);

/// Viewpoints in the camera frame, from the left behind the camera and from above, that show nearly
/// all points of a range image.
Viewpoint frame_viewpoint_left(const ImageF& range_m, const PixelRays& rays);
Viewpoint frame_viewpoint_above(const ImageF& range_m, const PixelRays& rays);

}  // namespace tofmap
