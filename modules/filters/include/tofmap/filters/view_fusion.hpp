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

/// Ranges of one frame and where the camera was. The image must outlive its use.
struct PosedView {
  const RangeImage* image = nullptr;
  Pose world_from_camera = Pose::Identity();
};

struct FusionOptions {
  int views = 2;
  double max_sigmas = 3;
  double tolerance_m = 0.01;

  static std::vector<OptionField<FusionOptions>> fields();
};

/// Fuses a frame's ranges with those that other views have of the same surfaces.
///
/// For each valid pixel the surface of every other view is intersected with the pixel's ray: the
/// point of the ray whose depth in the other camera is that of the other image there, between four
/// pixels without a step, by two steps of the secant method. Where that range agrees with the
/// pixel's own within `max_sigmas` of the noise of both and `tolerance_m` (of poses), it is
/// averaged in, weighted by confidence and noise and the less the farther it is off; sigma_m
/// becomes that of the mean.
///
/// A pixel that more views see through than agree with, at least two, is none of a surface that
/// stays: it is dropped as `free_space_violation` (flying pixels, what moves, wrong wraps). No
/// pixel becomes valid. `FusionOptions::views` is for the caller, who chooses the views.
///
/// Throws UsageError if images and camera differ in size.
RangeImage fuse_views(const PosedView& view, std::span<const PosedView> others,
                      const CameraModel& camera, const PixelRays& rays,
                      const FusionOptions& options);

}  // namespace tofmap
