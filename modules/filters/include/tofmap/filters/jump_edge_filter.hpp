// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops flying pixels at jump edges (May et al., Three-dimensional mapping with time-of-flight
/// cameras, JFR 26(11-12), 2009).
///
/// Looks at the triangle of the optical centre, a point p_i and each of its 8 neighbours p_n:
/// where the angle at p_i, between the line to the optical centre and the line to p_n, exceeds
/// `max_angle_rad`, p_n lies almost straight behind p_i, and p_i is dropped. A flying pixel has
/// the farther surface behind it. So has the last pixel of the nearer surface, which goes too;
/// the first pixel of the farther surface has its neighbour in front, at a small angle, and
/// stays. Every pixel is judged by the image as it came in. Neighbours outside the image or
/// invalid say nothing.
///
/// Where pixels are dense, noise alone puts neighbours behind one another, and the filter as
/// published eats far surfaces. So neighbours whose gap to p_i is less than `min_gap_sigmas`
/// standard deviations of the range noise of both say nothing either; 0 is the filter as published.
///
/// To be used after unwrapping: before, every wrap boundary looks like an edge.
/// Throws UsageError if image and rays differ in size.
RangeImage drop_jump_edges(const RangeImage& image, const PixelRays& rays, double max_angle_rad,
                           double min_gap_sigmas);

}  // namespace tofmap
