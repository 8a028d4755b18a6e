// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops statistical outliers: points that are farther from their nearest neighbours than is usual
/// in this image.
///
/// The idea is that of Rusu et al. (Towards 3D point cloud based object maps for household
/// environments, RAS 56(11), 2008). Here distances are divided by the distance that is expected
/// from range, angle between the pixels and predicted noise (docs/filters.md, equation 8), so that
/// points of far or noisy surfaces are not outliers. The score of a pixel is the mean of these
/// ratios over the nearest quarter of the valid pixels in the 5 x 5 around it. A pixel is dropped,
/// with the reason `outlier`, if its score exceeds the median over the image by more than
/// `max_deviations` standard deviations (estimated from the median absolute deviation, at least
/// 0.1), or if fewer than four pixels around it are valid.
///
/// Apply it after unwrapping. Throws UsageError if image and rays differ in size.
RangeImage drop_outliers(const RangeImage& image, const PixelRays& rays, double max_deviations);

}  // namespace tofmap
