// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/option_table.hpp>
#include <tofmap/core/range_image.hpp>
#include <tofmap/core/trajectory.hpp>

namespace tofmap {

/// Ranges of one frame and the pose of the camera. The image must outlive the view.
struct PosedView {
  const RangeImage* image = nullptr;  ///< not null
  Pose world_from_camera = Pose::Identity();
};

/// How frames are fused with their neighbours.
struct FusionOptions {
  /// Number of frames before and after each frame that are fused with it, 0 … 100. 0 turns fusion
  /// off. fuse_views() ignores it, since its caller chooses the views.
  int views = 2;

  /// Largest difference between ranges that are averaged, 0 … 100 standard deviations of both.
  double max_sigmas = 3;

  /// Displacement of surfaces by errors of the poses that is accepted, 0 … 10 m. It is added to
  /// max_sigmas in quadrature.
  double tolerance_m = 0.01;

  static std::vector<OptionField<FusionOptions>> fields();
};

/// Fuses the ranges of a frame with those that other views have of the same surfaces. All poses
/// share one world frame, and all images are of the same camera.
///
/// For each valid pixel, its ray is intersected with the surface of every other view: two steps of
/// the secant method find the point of the ray whose depth in the other camera equals the depth
/// that the other image has there, interpolated between four pixels of one surface. If the range of
/// that point agrees with the range of the pixel within `max_sigmas` and `tolerance_m`, it is
/// included in a weighted mean. Weights follow confidence and variance, and fall with the
/// difference from the pixel. sigma_m becomes the standard deviation of the mean.
///
/// A pixel is dropped, with the reason `free_space_violation`, if at least two views see through
/// it, and more views see through it than agree with it. Such pixels are flying pixels, moving
/// objects or wrong wrap counts. No pixel becomes valid.
///
/// Throws UsageError if an image and `rays` differ in size.
RangeImage fuse_views(const PosedView& view, std::span<const PosedView> others,
                      const CameraModel& camera, const PixelRays& rays,
                      const FusionOptions& options);

}  // namespace tofmap
