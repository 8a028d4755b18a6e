// SPDX-FileCopyrightText: 2026 the tofmap authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <tofmap/core/camera.hpp>
#include <tofmap/core/image.hpp>

namespace tofmap::kinect2 {

/// Position of the light source along the camera frame's x axis, in images whose columns are as the
/// camera sends them. In images that are mirrored back (mirror.hpp), it is negative.
///
/// Source: libfreenect2 computes depth z from the path d of the light and the normalised image
/// coordinates x and y as z = d² / 2(d √(x² + y² + 1) - x L) with L = 45 mm
/// (cpu_depth_packet_processor.cpp, where 2 L is 90, and libfreenect2.cpp). The formula here is
/// exact; that one leaves out L² in the numerator, which makes (L / 2)² / r, 0.5 mm in 1 m.
inline constexpr double light_source_x_m = 0.045;

/// The radial range from the lens, in metres, of a surface that is lit from beside the lens.
///
/// Light travels from the source at s to the surface at r v, where r is the range and the unit
/// vector v is the pixel's ray, and back to the lens in the origin. What a phase measures, φ λ, is
/// half of that path: h = (|r v - s| + r) / 2. Squaring |r v - s| = 2h - r yields
///
///     r = (4 h² - s·s) / 2(2 h - v·s).
///
/// `half_path_m` is h, `ray` is v and `source_m` is s, in the camera frame, metres. The result is
/// NaN if h is NaN or no path via a surface is so short, 2 h <= |s|.
double range_from_half_path(double half_path_m, const Eigen::Vector3d& ray,
                            const Eigen::Vector3d& source_m);

/// Half of the path of the light to a surface at a radial range and back: the inverse of
/// range_from_half_path(). NaN if the range is NaN or negative.
double half_path_from_range(double range_m, const Eigen::Vector3d& ray,
                            const Eigen::Vector3d& source_m);

/// The range for which half_path_offset() is exact by default. With the Kinect's light source, the
/// offset is then right to 0.51 mm at all ranges from 0.5 m on.
inline constexpr double reference_range_m = 1;

/// Half of the light's path minus the radial range, for every pixel at `range_m`, in metres.
///
/// This difference depends on the range, which is unknown before unwrapping, but hardly so:
/// h - r = -v·s / 2 + (s·s - (v·s)²) / 4r + …, where the first term, up to 13 mm at the left and
/// right edge of a Kinect's image, does not depend on r. If the offset for a range r₀ is applied at
/// all ranges, an error of at most s·s / 4 · |1/r - 1/r₀| remains. So subtracting one offset image
/// from the phases (shifted_phase()) makes them phases of radial ranges, to within the noise.
///
/// `range_m` may be infinite, for the first term alone. Throws UsageError unless it is above 0.
ImageF half_path_offset(const PixelRays& rays, const Eigen::Vector3d& source_m,
                        double range_m = reference_range_m);

/// The phases of ranges that are shorter by `offset_m`, in cycles, in [0, 1). NaN stays NaN. Throws
/// UsageError unless the images have the same size and the wavelength is above 0.
ImageF shifted_phase(const ImageF& phase, const ImageF& offset_m, double wavelength_m);

}  // namespace tofmap::kinect2
