// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops statistical outliers: points that are farther from their nearest neighbours than the
/// points of this image mostly are.
///
/// The idea is that of Rusu et al. (Towards 3D point cloud based object maps for household
/// environments, RAS 56(11), 2008), but distances are taken in units of what range, angle between
/// the pixels and predicted noise let expect, so that far surfaces are not outliers for being
/// sparse, nor noisy ones for their noise. The mean over the nearest quarter of the 5 x 5 around a
/// pixel is compared with the median over the image: more than `max_deviations` standard deviations
/// above it, estimated from the median absolute deviation, is an outlier. A pixel with fewer than
/// four valid ones around it is one, too.
///
/// To be used after unwrapping. Throws UsageError if image and rays differ in size.
RangeImage drop_outliers(const RangeImage& image, const PixelRays& rays, double max_deviations);

}  // namespace tofmap
