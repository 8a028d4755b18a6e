// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/visualization/drawing.hpp>

namespace tofmap {

/// The cloud of one frame without (top) and with unwrapping (bottom), from behind the camera's
/// left shoulder (left) and from above (right), as in figures 11 and 12 of the paper. Points whose
/// wrap count is not 0 are red: where they were wrapped to, and where they belong.
/// Throws DrawingError if nothing can be drawn on this machine.
Picture cloud_picture(const RangeImage& unwrapped, const ImageF& wrapped_m, const PixelRays& rays);

/// The points of ranges, each in the colour of its pixel, with the camera.
Drawing frame_drawing(const ImageF& range_m, const PixelRays& rays,
                      const std::function<Rgb(Eigen::Index row, Eigen::Index col)>& color);

/// The points of ranges that belong to an unwrapped image, as in `cloud_picture`, with the camera.
Drawing frame_drawing(const RangeImage& unwrapped, const ImageF& range_m, const PixelRays& rays);

/// Viewpoints that hold nearly all points of an image of ranges, in the camera's frame.
Viewpoint frame_viewpoint_left(const ImageF& range_m, const PixelRays& rays);
Viewpoint frame_viewpoint_above(const ImageF& range_m, const PixelRays& rays);

}  // namespace tofmap
