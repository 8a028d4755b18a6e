// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <tofmap/core/camera.hpp>
#include <tofmap/core/range_image.hpp>

namespace tofmap {

/// Drops flying pixels at jump edges (May et al., Three-dimensional mapping with time-of-flight
/// cameras, JFR 26(11-12), 2009).
///
/// The filter considers the triangle of the optical centre, a point p_i and each of its 8
/// neighbours p_n. If the angle at p_i, between the line to the optical centre and the line to p_n,
/// exceeds `max_angle_rad`, then p_n lies almost straight behind p_i, and p_i is dropped, with the
/// reason `jump_edge`. A flying pixel has the farther surface behind it and is dropped. The last
/// pixel of the nearer surface has it behind it as well, and is dropped, too. The first pixel of
/// the farther surface has its neighbour in front of it, at a small angle, and stays. The result
/// does not depend on the order of the pixels. Neighbours that are invalid or outside the image are
/// ignored.
///
/// Where pixels are dense, noise alone puts neighbours behind one another, so that the filter as
/// published drops most of a far surface. Therefore neighbours are ignored, too, if they are closer
/// to p_i than `min_gap_sigmas` standard deviations of the range errors of both pixels. 0 is the
/// filter as published.
///
/// Apply it after unwrapping: in wrapped ranges every wrap boundary looks like an edge.
/// Throws UsageError if image and rays differ in size.
RangeImage drop_jump_edges(const RangeImage& image, const PixelRays& rays, double max_angle_rad,
                           double min_gap_sigmas);

}  // namespace tofmap
